#include "quorient/configuration/values.hpp"

#include "quorient/configuration/suggestion.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::configuration {

namespace {

const Bounds anything{};

const Bounds& bounds_of(const Key& key)
{
    return key.bounds ? *key.bounds : anything;
}

template <class Values>
YAML::Node sequence(const Values& values)
{
    YAML::Node node{YAML::NodeType::Sequence};
    for (const auto& value : values) node.push_back(to_node(value));
    node.SetStyle(YAML::EmitterStyle::Flow);
    return node;
}

}  // namespace

std::string form_of(double)
{
    return "number";
}

std::string form_of(bool)
{
    return "true or false";
}

std::string form_of(std::uint32_t)
{
    return "whole number";
}

std::string form_of(std::uint64_t)
{
    return "whole number";
}

std::string form_of(const std::string&)
{
    return "text";
}

std::string form_of(const std::array<double, 3>&)
{
    return "[x, y, z]";
}

std::string form_of(const std::vector<double>&)
{
    return "list of numbers";
}

std::string form_of(const std::vector<std::uint32_t>&)
{
    return "list of whole numbers";
}

std::string form_of(const std::vector<std::string>&)
{
    return "list of texts";
}

void read_value(Section& section, const Key& key, bool& value)
{
    section.boolean(key.name, value);
}

void read_value(Section& section, const Key& key, double& value)
{
    section.number(key.name, value, bounds_of(key), key.unit);
}

void read_value(Section& section, const Key& key, std::uint32_t& value)
{
    section.whole(key.name, value, bounds_of(key), key.unit);
}

void read_value(Section& section, const Key& key, std::uint64_t& value)
{
    section.whole(key.name, value, bounds_of(key), key.unit);
}

void read_value(Section& section, const Key& key, std::string& value)
{
    section.text(key.name, value);
}

void read_value(Section& section, const Key& key, std::array<double, 3>& value)
{
    if (!section.has(key.name)) return;
    const YAML::Node node = section.raw(key.name);
    std::vector<double> numbers;
    if (node.IsSequence() && node.size() == value.size()) section.numbers(key.name, numbers, bounds_of(key));
    else section.problem(key.name, fmt::format("expected [x, y, z]{}", key.unit.empty() ? "" : ", each in " + key.unit));
    if (numbers.size() == value.size()) std::ranges::copy(numbers, value.begin());
}

void read_value(Section& section, const Key& key, std::vector<double>& value)
{
    section.numbers(key.name, value, bounds_of(key));
}

void read_value(Section& section, const Key& key, std::vector<std::uint32_t>& value)
{
    section.wholes(key.name, value, bounds_of(key));
}

void read_value(Section& section, const Key& key, std::vector<std::string>& value)
{
    section.texts(key.name, value);
}

std::optional<std::size_t> read_word(Section& section, const Key& key, const std::string& noun)
{
    std::string text;
    section.text(key.name, text);
    if (text.empty()) return std::nullopt;
    const auto found = std::ranges::find(key.words, text);
    if (found != key.words.end()) return static_cast<std::size_t>(found - key.words.begin());
    section.problem(key.name, fmt::format("unknown {} '{}'; there {} {}{}", noun, text, key.words.size() == 1 ? "is" : "are",
                                          listed(key.words), suggestion(text, key.words)));
    return std::nullopt;
}

YAML::Node to_node(bool value)
{
    return YAML::Node{value ? "true" : "false"};
}

YAML::Node to_node(double value)
{
    return YAML::Node{fmt::format("{}", value)};
}

YAML::Node to_node(std::uint32_t value)
{
    return YAML::Node{fmt::format("{}", value)};
}

YAML::Node to_node(std::uint64_t value)
{
    return YAML::Node{fmt::format("{}", value)};
}

YAML::Node to_node(const std::string& value)
{
    return YAML::Node{value};
}

YAML::Node to_node(const std::array<double, 3>& values)
{
    return sequence(values);
}

YAML::Node to_node(const std::vector<double>& values)
{
    return sequence(values);
}

YAML::Node to_node(const std::vector<std::uint32_t>& values)
{
    return sequence(values);
}

YAML::Node to_node(const std::vector<std::string>& values)
{
    return sequence(values);
}

std::string to_text(const YAML::Node& node)
{
    YAML::Emitter emitter;
    emitter << node;
    return emitter.c_str();
}

std::string shown(const YAML::Node& node)
{
    if (!node.IsDefined()) return {};
    YAML::Emitter emitter;
    emitter.SetSeqFormat(YAML::Flow);
    emitter.SetMapFormat(YAML::Flow);
    emitter << node;
    return emitter.c_str();
}

bool is_same(const YAML::Node& value, const YAML::Node& mapping, const std::string& key)
{
    if (!mapping.IsMap()) return false;
    const YAML::Node other = mapping[key];
    return other.IsDefined() && shown(other) == shown(value);
}

std::string too_many(const std::string& what, std::size_t most, std::size_t got)
{
    return fmt::format("at most {} {}, got {}", most, what, got);
}

}  // namespace quorient::configuration
