#include "files.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>
#include <cmath>
#include <map>

namespace quorient::system {

namespace {

using configuration::Chapter;
using configuration::Key;
using testing::HasSubstr;

/// A value that a key must refuse, and where in it the fault is ("[0]": its first entry).
struct Wrong {
    std::string value;
    std::string entry{};
};

/// For keys whose form is their own.
const std::map<std::string, std::vector<Wrong>> wrong_values{
    {"axes", {{"1"}, {"[[1, 0, 0], [0, 1, 0]]"}, {"[[2, 0, 0], [0, 1, 0], [0, 0, 1]]"}, {"[[1, 0], [0, 1], [0, 0]]"}}},
    {"initial_attitude", {{"level"}, {"[1, 0, 0]"}, {"[1.002, 0, 0, 0]"}, {"[[1, 0, 0], [0, 1, 0], [0, 0, -1]]"}}},
    {"rotation",
     {{"level"}, {"[1, 0, 0]"}, {"[1.002, 0, 0, 0]"}, {"[[1, 0, 0], [0, 1, 0], [0, 0, -1]]"}, {"[[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]"}}},
    {"A", {{"1"}, {"[[1, 2], [3]]"}, {"[[x]]"}}},
    {"B", {{"1"}, {"[[1], [x]]"}}},
    {"C", {{"1"}, {"[[1, 2], x]"}}},
    {"poles", {{"-3"}, {"[-3, -4]"}, {"[[x]]"}}},
    {"compose", {{"fdi-a"}, {"[fdi-a]", "[0]"}, {"[[fdi-a, [attitude-a]]]", "[0]"}}},
    {"file", {{"{a: 1}"}, {"[]"}}},
    {"calibration", {{"[a]"}}},
};

std::vector<Wrong> beyond(const settings::Bounds& bounds)
{
    std::vector<Wrong> wrong;
    if (std::isfinite(bounds.lowest)) wrong.push_back({fmt::format("{}", bounds.lowest_included ? bounds.lowest - 1 : bounds.lowest)});
    if (std::isfinite(bounds.highest)) wrong.push_back({fmt::format("{}", bounds.highest_included ? bounds.highest + 1 : bounds.highest)});
    return wrong;
}

std::vector<Wrong> wrong_for(const Key& key)
{
    if (const auto own = wrong_values.find(key.name); own != wrong_values.end()) return own->second;
    if (!key.words.empty()) return {{"no-such-word"}, {"[1]"}};
    if (key.form == "ROS 2 topic") return {{"/"}, {"[a]"}};
    if (key.form == "[x, y, z]") return {{"[1, 2]"}, {"[1, 2, x]", "[2]"}, {"1"}};
    if (key.form == "mapping") return {{"[1]"}, {"1"}};
    if (key.form == "list of mappings") return {{"{a: 1}"}, {"1"}};
    if (key.form == "true or false") return {{"maybe"}, {"1"}};
    if (key.form == "text") return {{"[a]"}, {"{a: 1}"}};
    if (key.form == "list of texts") return {{"a"}, {"[[a]]", "[0]"}};
    std::vector<Wrong> wrong = key.bounds ? beyond(*key.bounds) : std::vector<Wrong>{};
    if (key.form.starts_with("list of"))
        for (auto& value : wrong) value = {"[" + value.value + "]", "[0]"};
    wrong.push_back({"many"});
    wrong.push_back({"{a: 1}"});
    return wrong;
}

/// "lanes[0].detector" -> lanes, 0, detector. Written anew here: what is tested does not say itself where a key stands.
YAML::Node node_at(const YAML::Node& document, const std::string& path)
{
    YAML::Node node;
    node.reset(document);
    std::string step;
    for (const char letter : path + ".") {
        if (letter != '.' && letter != '[' && letter != ']') {
            step += letter;
            continue;
        }
        if (step.empty()) continue;
        const bool number = step.find_first_not_of("0123456789") == std::string::npos;
        node.reset(number ? node[std::stoul(step)] : node[step]);
        step.clear();
    }
    return node;
}

/// Goes through all keys of a file of one kind.
class Walk {
public:
    Walk(const std::string& base, std::string unit_kind, std::string source_kind)
        : base_(base), unit_kind_(std::move(unit_kind)), source_kind_(std::move(source_kind))
    {
    }

    void chapter(const Chapter& chapter, const std::string& path)
    {
        for (const auto& entry : chapter.keys) key(entry, path);
        for (const auto& variant : chapter.variants) {
            if (variant.when.starts_with("unit.kind: ")) {
                if (variant.when.find(unit_kind_) != std::string::npos) keys(variant.keys, path);
            } else if (path == "source" || path == "unit") {
                const bool holds = variant.when == "kind: " + (path == "unit" ? unit_kind_ : source_kind_);
                if (holds && (path == "unit" || unit_kind_ != "vessel_rates")) keys(variant.keys, path);
            } else if (variant.when.starts_with("kind: ")) {
                kind_ = {path + ".kind", variant.when.substr(6)};
                keys(variant.keys, path);
                kind_ = {};
            }
        }
    }

    std::size_t tried() const { return tried_; }

private:
    void keys(const std::vector<Key>& all, const std::string& path)
    {
        for (const auto& entry : all) key(entry, path);
    }

    void key(const Key& key, const std::string& mapping)
    {
        if (key.form == "anything") return;
        const auto path = mapping.empty() ? key.name : mapping + "." + key.name;
        for (const auto& wrong : wrong_for(key)) refuses(path, wrong);
        for (const auto& part : key.parts) chapter(part, key.form == "list of mappings" ? path + "[0]" : path);
    }

    /// The wrong value in place of the right one must be reported at its line and column, by its name.
    void refuses(const std::string& path, const Wrong& wrong)
    {
        YAML::Node document = YAML::Load(base_);
        if (!kind_.first.empty()) node_at(document, kind_.first) = kind_.second;
        node_at(document, path) = YAML::Load(wrong.value);
        YAML::Emitter text;
        text << document;
        const std::string written = std::string(text.c_str()) + "\n";
        const auto mark = node_at(YAML::Load(written), path + wrong.entry).Mark();
        EXPECT_THAT(refusal(written), HasSubstr(fmt::format("system.yaml:{}:{}: {}{}", mark.line + 1, mark.column + 1, path, wrong.entry)))
            << path << ": " << wrong.value << "\n"
            << written;
        ++tried_;
    }

    std::string base_;
    std::string unit_kind_;
    std::string source_kind_;
    std::pair<std::string, std::string> kind_;
    std::size_t tried_ = 0;
};

std::size_t walk(const std::string& base, const std::string& unit_kind, const std::string& source_kind = "simulation")
{
    EXPECT_EQ(refusal(base), "accepted");
    Walk all(base, unit_kind, source_kind);
    all.chapter(reference(), "");
    return all.tried();
}

void expect_described(const Chapter& chapter, const std::string& path)
{
    for (const auto& key : chapter.keys) {
        EXPECT_FALSE(key.sentence.empty()) << path << "." << key.name;
        EXPECT_TRUE(key.sentence.ends_with('.') || key.sentence.ends_with("…")) << path << "." << key.name;
        EXPECT_FALSE(key.form.empty()) << path << "." << key.name;
        if (key.parts.empty() && !key.required) {
            EXPECT_FALSE(key.otherwise.empty()) << path << "." << key.name << " does not say what holds without it";
        }
        for (const auto& part : key.parts) expect_described(part, path + "." + key.name);
    }
    for (const auto& variant : chapter.variants) expect_described(variant, path);
}

}  // namespace

TEST(EveryKey, is_refused_beyond_its_bounds_at_its_own_place_in_a_simulation)
{
    EXPECT_GT(walk(simulation_file, "gyro"), 200U);
}

TEST(EveryKey, is_refused_beyond_its_bounds_at_its_own_place_for_a_log)
{
    EXPECT_GT(walk(log_file, "gyro", "log"), 200U);
}

TEST(EveryKey, is_refused_beyond_its_bounds_at_its_own_place_for_imus_of_ros2)
{
    EXPECT_GT(walk(ros2_file, "gyro", "ros2_imu"), 200U);
}

TEST(EveryKey, is_refused_beyond_its_bounds_at_its_own_place_for_accelerometers)
{
    EXPECT_GT(walk(accelerometer_file, "accelerometer"), 100U);
}

TEST(EveryKey, is_refused_beyond_its_bounds_at_its_own_place_for_a_vessel)
{
    EXPECT_GT(walk(vessel_file, "vessel_rates"), 100U);
}

TEST(EveryKey, has_a_form_a_sentence_and_what_holds_without_it)
{
    expect_described(reference(), "");
}

}  // namespace quorient::system
