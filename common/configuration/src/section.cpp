#include "quorient/configuration/section.hpp"

#include "quorient/configuration/suggestion.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace quorient::configuration {

namespace {

template <class Number>
std::optional<Number> parsed(const YAML::Node& node)
{
    if (!node.IsScalar()) return std::nullopt;
    const auto& text = node.Scalar();
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    if constexpr (std::is_floating_point_v<Number>)
        if (!std::isfinite(value)) return std::nullopt;
    return value;
}

std::string described(const YAML::Node& node)
{
    if (node.IsScalar()) return fmt::format("'{}'", node.Scalar());
    if (node.IsSequence()) return "a list";
    if (node.IsMap()) return "a mapping";
    return "nothing";
}

std::string in_brackets(std::string_view unit)
{
    return unit.empty() ? std::string{} : fmt::format(" [{}]", unit);
}

}  // namespace

Section::Section(YAML::Node node, std::string path, Problems& problems)
    : node_(node.IsDefined() ? node : YAML::Node{}), path_(std::move(path)), problems_(&problems)
{
    if (!node_.IsNull() && !node_.IsMap()) {
        problems_->add(node_.Mark(), path_, fmt::format("{} must be a mapping of keys to values, got {}", path_, described(node_)));
        node_.reset(YAML::Node{});
    }
    std::map<std::string, YAML::Mark> seen;
    for (const auto& entry : node_) {
        const auto key = entry.first.IsScalar() ? entry.first.Scalar() : std::string{};
        const auto [earlier, is_new] = seen.emplace(key, entry.first.Mark());
        if (!is_new)
            problems_->add(entry.first.Mark(), name_of(key),
                           fmt::format("{}: stands here a second time, first in line {}", name_of(key), earlier->second.line + 1));
    }
}

std::size_t Section::problem_count() const
{
    return problems_->count();
}

std::string Section::name_of(std::string_view key) const
{
    return path_.empty() ? std::string{key} : fmt::format("{}.{}", path_, key);
}

YAML::Node Section::find(std::string_view key)
{
    asked_.emplace_back(key);
    const YAML::Node& node = node_;
    const auto value = node.IsMap() ? node[asked_.back()] : YAML::Node{YAML::NodeType::Undefined};
    return value.IsDefined() && value.IsNull() ? YAML::Node{YAML::NodeType::Undefined} : value;
}

bool Section::has(std::string_view key)
{
    return find(key).IsDefined();
}

void Section::problem(std::string_view key, std::string_view what)
{
    const auto node = find(key);
    problems_->add(node.IsDefined() ? node.Mark() : node_.Mark(), name_of(key), fmt::format("{}: {}", name_of(key), what));
}

void Section::problem(std::string_view key, std::size_t entry, std::string_view what)
{
    const auto name = fmt::format("{}[{}]", name_of(key), entry);
    problems_->add(find(key)[entry].Mark(), name, fmt::format("{}: {}", name, what));
}

bool Section::is_in_order(std::string_view key, std::optional<double> number, const YAML::Node& node, const Bounds& bounds,
                          std::string_view unit, std::string_view form)
{
    if (!number) problem(key, fmt::format("expected {}{}, got {}", form, in_brackets(unit), described(node)));
    else if (!bounds.hold(*number)) problem(key, fmt::format("must be {}{}, got {}", bounds.text(), in_brackets(unit), node.Scalar()));
    return number && bounds.hold(*number);
}

void Section::number(std::string_view key, double& value, const Bounds& bounds, std::string_view unit)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    const auto read = parsed<double>(node);
    if (is_in_order(key, read, node, bounds, unit, "a number")) value = *read;
}

void Section::number(std::string_view key, std::optional<double>& value, const Bounds& bounds, std::string_view unit)
{
    double read = std::numeric_limits<double>::quiet_NaN();
    number(key, read, bounds, unit);
    if (!std::isnan(read)) value = read;
}

template <class Whole>
void Section::read_whole(std::string_view key, Whole& value, const Bounds& bounds, std::string_view unit)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    const auto read = parsed<Whole>(node);
    const auto number = read ? std::optional(static_cast<double>(*read)) : std::nullopt;
    if (is_in_order(key, number, node, bounds, unit, "a whole number")) value = *read;
}

void Section::whole(std::string_view key, std::uint32_t& value, const Bounds& bounds, std::string_view unit)
{
    read_whole(key, value, bounds, unit);
}

void Section::whole(std::string_view key, std::uint64_t& value, const Bounds& bounds, std::string_view unit)
{
    read_whole(key, value, bounds, unit);
}

void Section::whole(std::string_view key, std::optional<std::uint32_t>& value, const Bounds& bounds, std::string_view unit)
{
    if (!has(key)) return;
    std::uint32_t read = 0;
    const auto problems = problem_count();
    whole(key, read, bounds, unit);
    if (problem_count() == problems) value = read;
}

void Section::text(std::string_view key, std::string& value)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    if (node.IsScalar() && !node.Scalar().empty()) value = node.Scalar();
    else problem(key, fmt::format("expected a word, got {}", described(node)));
}

void Section::boolean(std::string_view key, bool& value)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    const auto word = node.IsScalar() ? node.Scalar() : std::string{};
    if (word == "true" || word == "false") value = word == "true";
    else problem(key, fmt::format("expected true or false, got {}", described(node)));
}

template <class Number>
void Section::read_list(std::string_view key, std::vector<Number>& value, const Bounds& bounds, std::string_view form)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    if (!node.IsSequence()) return problem(key, fmt::format("expected a list of {}s, got {}", form, described(node)));
    value.clear();
    for (std::size_t i = 0; i < node.size(); ++i) {
        const auto read = parsed<Number>(node[i]);
        if (read && bounds.hold(static_cast<double>(*read))) value.push_back(*read);
        else
            problem(key, i,
                    fmt::format("expected a {}{}{}, got {}", form, bounds.text().empty() ? "" : ", ", bounds.text(), described(node[i])));
    }
}

void Section::numbers(std::string_view key, std::vector<double>& value, const Bounds& bounds)
{
    read_list(key, value, bounds, "number");
}

void Section::wholes(std::string_view key, std::vector<std::uint32_t>& value, const Bounds& bounds)
{
    read_list(key, value, bounds, "whole number");
}

void Section::texts(std::string_view key, std::vector<std::string>& value)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    if (!node.IsSequence()) return problem(key, fmt::format("expected a list, got {}", described(node)));
    value.clear();
    for (std::size_t i = 0; i < node.size(); ++i) {
        if (node[i].IsScalar()) value.push_back(node[i].Scalar());
        else problem(key, i, fmt::format("expected a word, got {}", described(node[i])));
    }
}

void Section::require(std::string_view key)
{
    if (!has(key)) problems_->add(node_.Mark(), name_of(key), fmt::format("{} is missing", name_of(key)));
}

Section Section::section(std::string_view key)
{
    return {find(key), name_of(key), *problems_};
}

std::vector<Section> Section::sections(std::string_view key)
{
    const auto node = find(key);
    std::vector<Section> result;
    if (!node.IsDefined()) return result;
    if (!node.IsSequence()) {
        problem(key, fmt::format("expected a list, got {}", described(node)));
        return result;
    }
    for (std::size_t i = 0; i < node.size(); ++i) result.emplace_back(node[i], fmt::format("{}[{}]", name_of(key), i), *problems_);
    return result;
}

YAML::Node Section::raw(std::string_view key)
{
    return find(key);
}

void Section::finish()
{
    if (!node_.IsMap()) return;
    for (const auto& entry : node_) {
        const auto key = entry.first.IsScalar() ? entry.first.Scalar() : std::string{};
        if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
        problems_->add(entry.first.Mark(), name_of(key),
                       fmt::format("unknown key '{}'{}{}", key, path_.empty() ? "" : " in " + path_, suggestion(key, asked_)));
    }
}

}  // namespace quorient::configuration
