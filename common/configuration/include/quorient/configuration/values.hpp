#pragma once

#include "quorient/configuration/key.hpp"
#include "quorient/configuration/section.hpp"

#include <yaml-cpp/yaml.h>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quorient::configuration {

// The forms that values of tables have: as a reader calls them, how a section reads them, how they are written again.

std::string form_of(double);
std::string form_of(bool);
std::string form_of(std::uint32_t);
std::string form_of(std::uint64_t);
std::string form_of(const std::string&);
std::string form_of(const std::array<double, 3>&);
std::string form_of(const std::vector<double>&);
std::string form_of(const std::vector<std::uint32_t>&);
std::string form_of(const std::vector<std::string>&);
template <class Value>
std::string form_of(const std::optional<Value>&)
{
    return form_of(Value{});
}

void read_value(Section& section, const Key& key, bool& value);
void read_value(Section& section, const Key& key, double& value);
void read_value(Section& section, const Key& key, std::uint32_t& value);
void read_value(Section& section, const Key& key, std::uint64_t& value);
void read_value(Section& section, const Key& key, std::string& value);
void read_value(Section& section, const Key& key, std::array<double, 3>& value);
void read_value(Section& section, const Key& key, std::vector<double>& value);
void read_value(Section& section, const Key& key, std::vector<std::uint32_t>& value);
void read_value(Section& section, const Key& key, std::vector<std::string>& value);
template <class Value>
void read_value(Section& section, const Key& key, std::optional<Value>& value)
{
    if (!section.has(key.name)) return;
    Value read = value.value_or(Value{});
    const auto problems = section.problem_count();
    read_value(section, key, read);
    if (section.problem_count() == problems) value = read;
}

/// @returns which of the key's words stands there; nothing where it is absent, or unknown, which is then a problem.
std::optional<std::size_t> read_word(Section& section, const Key& key, const std::string& noun);

/// Numbers with as many digits as reading them back bit for bit needs.
YAML::Node to_node(bool value);
YAML::Node to_node(double value);
YAML::Node to_node(std::uint32_t value);
YAML::Node to_node(std::uint64_t value);
YAML::Node to_node(const std::string& value);
YAML::Node to_node(const std::array<double, 3>& values);
YAML::Node to_node(const std::vector<double>& values);
YAML::Node to_node(const std::vector<std::uint32_t>& values);
YAML::Node to_node(const std::vector<std::string>& values);
template <class Value>
YAML::Node to_node(const std::optional<Value>& value)
{
    return value ? to_node(*value) : YAML::Node{YAML::NodeType::Undefined};
}

/// The text of a node in one line; empty for an undefined one.
std::string shown(const YAML::Node& node);

/// A document as text. What it reads back to is equal.
std::string to_text(const YAML::Node& node);

/// Whether a mapping holds the same value under this key.
bool is_same(const YAML::Node& value, const YAML::Node& mapping, const std::string& key);

std::string too_many(const std::string& what, std::size_t most, std::size_t got);

}  // namespace quorient::configuration
