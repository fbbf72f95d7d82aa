// The command line of every service.

#include "quorient/runtime/options.hpp"

#include <gmock/gmock.h>
#include <string>
#include <vector>

namespace quorient::runtime {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Parsed {
    tl::expected<Options, OptionsError> options;
    std::string out;
    std::string err;
};

Parsed parsed(std::vector<std::string> words, const std::string& default_name = "")
{
    words.insert(words.begin(), "/usr/bin/quorient-fdi");
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    auto options = parse_options(static_cast<int>(argv.size()), argv.data(), "Finds faults.", default_name,
                                 {{"--allow-orders", "Obeys orders.", "monitor.orders=true"}});
    auto out = testing::internal::GetCapturedStdout();
    return {std::move(options), std::move(out), testing::internal::GetCapturedStderr()};
}

TEST(ServiceOptions, are_all_read)
{
    const auto got = parsed(
        {"demo.yaml", "--name", "fdi-a", "--dds", "cyclonedds", "--domain", "7", "--set", "a=1", "--allow-orders", "--set", "b=2"});
    ASSERT_TRUE(got.options) << got.err;
    EXPECT_EQ(got.options->system_file, "demo.yaml");
    EXPECT_EQ(got.options->name, "fdi-a");
    EXPECT_EQ(got.options->dds, Vendor::cyclonedds);
    EXPECT_EQ(got.options->domain, 7U);
    EXPECT_THAT(got.options->set, testing::UnorderedElementsAre("a=1", "b=2", "monitor.orders=true"));
}

TEST(ServiceOptions, leave_to_the_file_what_is_not_given)
{
    const auto got = parsed({"demo.yaml"}, "sensor");
    ASSERT_TRUE(got.options) << got.err;
    EXPECT_EQ(got.options->name, "sensor");
    EXPECT_FALSE(got.options->dds);
    EXPECT_FALSE(got.options->domain);
    EXPECT_THAT(got.options->set, ElementsAre());
}

TEST(ServiceOptions, do_not_take_the_file_for_a_value_to_set)
{
    const auto got = parsed({"--set", "a=1", "demo.yaml"}, "sensor");
    ASSERT_TRUE(got.options) << got.err;
    EXPECT_EQ(got.options->system_file, "demo.yaml");
    EXPECT_THAT(got.options->set, ElementsAre("a=1"));
}

TEST(ServiceOptions, with_a_mistake_end_with_2_and_the_reason)
{
    const auto expect_refused = [](const std::vector<std::string>& words, const char* reason) {
        const auto got = parsed(words);
        ASSERT_FALSE(got.options) << reason;
        EXPECT_EQ(got.options.error().exit_code, 2);
        EXPECT_THAT(got.err, HasSubstr(reason));
    };
    expect_refused({"--name", "fdi-a"}, "system is required");
    expect_refused({"demo.yaml"}, "--name is required");
    expect_refused({"demo.yaml", "--name", "fdi-a", "--dds", "opensplice"}, "opensplice");
    expect_refused({"demo.yaml", "--name", "fdi-a", "--domain", "seven"}, "seven");
    expect_refused({"demo.yaml", "--name", "fdi-a", "--nmae", "x"}, "--nmae");
    expect_refused({"--name", "fdi-a", "--set", "a=1", "b=2", "demo.yaml"}, "demo.yaml");  // each --set takes one value
}

TEST(ServiceOptions, help_and_version_end_with_0)
{
    const auto help = parsed({"--help"});
    ASSERT_FALSE(help.options);
    EXPECT_EQ(help.options.error().exit_code, 0);
    EXPECT_THAT(help.out, testing::AllOf(HasSubstr("Finds faults."), HasSubstr("quorient-fdi demo.yaml --name"), HasSubstr("--allow-orders")));
    const auto asked = parsed({"--version"});
    ASSERT_FALSE(asked.options);
    EXPECT_EQ(asked.options.error().exit_code, 0);
    EXPECT_THAT(asked.out, HasSubstr(version()));
}

}  // namespace

}  // namespace quorient::runtime
