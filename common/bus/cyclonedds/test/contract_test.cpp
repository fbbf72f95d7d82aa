// The table of idl/README.md is what the services ask their vendor for.

#include "../src/types.hpp"

#include <gmock/gmock.h>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace quorient::bus {

namespace {

struct Row {
    std::string type;
    std::set<std::string> key;
    std::string qos;
};

std::set<std::string> words(const std::string& list)
{
    std::set<std::string> result;
    std::istringstream stream{list};
    for (std::string word; std::getline(stream, word, ',');) result.insert(std::regex_replace(word, std::regex{"^ +| +$"}, ""));
    return result;
}

std::map<std::string, Row> documented()
{
    std::ifstream readme{QUORIENT_SOURCE_DIR "/idl/README.md"};
    const std::regex row{R"(\| `(quorient/\w+)` \| (\w+) \| ([^|]+) \| [^|]+ \| ([^|]+) \| [^|]+ \|)"};
    std::map<std::string, Row> rows;
    std::smatch found;
    for (std::string line; std::getline(readme, line);) {
        if (std::regex_match(line, found, row)) rows[found[1]] = {found[2], words(found[3]), found[4]};
    }
    return rows;
}

/// As the table spells it.
std::set<std::string> spelled(const Qos& qos)
{
    std::set<std::string> result{qos.reliable ? "RELIABLE" : "BEST_EFFORT", qos.transient_local ? "TRANSIENT_LOCAL" : "VOLATILE",
                                 "KEEP_LAST " + std::to_string(qos.depth)};
    if (qos.exclusive) result.insert({"EXCLUSIVE ownership", "MANUAL_BY_TOPIC liveliness"});
    return result;
}

TEST(Contract, states_the_type_key_and_quality_of_service_of_every_topic)
{
    auto rows = documented();
    const auto compare = [&](const TopicSpec& topic) {
        SCOPED_TRACE(topic.name);
        ASSERT_TRUE(rows.contains(topic.name));
        const auto& row = rows[topic.name];
        const auto& descriptor = cyclonedds::descriptor_of(topic.type);
        EXPECT_EQ("quorient_msgs::" + row.type, descriptor.m_typename);
        std::set<std::string> keys;
        for (std::uint32_t i = 0; i < descriptor.m_nkeys; ++i) keys.insert(descriptor.m_keys[i].m_name);
        EXPECT_EQ(row.key, keys);
        // Beside the policies the table may say more in words: the lease, and that SHARED is meant where it is the default.
        auto policies = words(row.qos);
        std::erase_if(policies, [](const std::string& word) { return word.starts_with("lease") || word.ends_with("intervals)"); });
        if (!topic.qos.exclusive) policies.erase("SHARED ownership");
        EXPECT_EQ(policies, spelled(topic.qos));
    };
    std::apply([&](const auto&... topic) { (compare(topic.spec), ...); }, topics::all);
    EXPECT_EQ(rows.size(), std::tuple_size_v<decltype(topics::all)>) << "the table lists a topic that the code does not have";
}

}  // namespace

}  // namespace quorient::bus
