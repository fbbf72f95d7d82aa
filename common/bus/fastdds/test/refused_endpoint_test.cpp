#include "../src/refused_endpoint.hpp"

#include <gtest/gtest.h>

namespace quorient::bus::fastdds {

namespace {

// As Fast DDS 2.9.1 logged it for a detector that published frames.
const std::string of_writer =
    "Error checking create remote writer b5.2f.99.4a.8d.2c.90.b5.7d.aa.3.ef|0.0.c.2 (quorient/frame topic not found in allow rule. "
    "(./src/cpp/security/accesscontrol/Permissions.cpp:1247))\n";

TEST(RefusedEndpoint, is_read_from_the_librarys_log_with_its_participant_and_topic)
{
    const auto refused = refused_endpoint(of_writer);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->participant, (GuidPrefix{0xb5, 0x2f, 0x99, 0x4a, 0x8d, 0x2c, 0x90, 0xb5, 0x7d, 0xaa, 0x03, 0xef}));
    EXPECT_TRUE(refused->publishes);
    EXPECT_EQ(refused->topic, "quorient/frame");
}

TEST(RefusedEndpoint, is_a_subscription_where_the_library_refused_a_reader)
{
    auto entry = of_writer;
    entry.replace(entry.find("writer"), 6, "reader");
    const auto refused = refused_endpoint(entry);
    ASSERT_TRUE(refused);
    EXPECT_FALSE(refused->publishes);
}

TEST(RefusedEndpoint, is_nothing_in_other_entries_and_in_damaged_ones)
{
    for (const auto* entry : {"", "Error checking creation of local reader  (quorient/frame topic not found in allow rule.)",
                              "Error checking create remote writer b5.2f|0.0.c.2 (quorient/frame topic not found in allow rule.)",
                              "Error checking create remote writer zz|0.0.c.2 (quorient/frame topic not found in allow rule.)"})
        EXPECT_FALSE(refused_endpoint(entry)) << entry;
}

TEST(RefusedEndpoint, is_announced_by_an_entry_that_names_no_participant)
{
    EXPECT_TRUE(announces_refused_endpoint("quorient/frame topic not found in allow rule. (./src/cpp/security/accesscontrol/Permissions.cpp:1247)"));
    EXPECT_FALSE(announces_refused_endpoint(of_writer));
    EXPECT_FALSE(announces_refused_endpoint("Error checking the certificate"));
}

}  // namespace

}  // namespace quorient::bus::fastdds
