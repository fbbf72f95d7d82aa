#include "quorient/runtime/yaml.hpp"

#include "quorient/runtime/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <charconv>
#include <cmath>

namespace quorient::runtime {

namespace {

std::optional<double> parse_number(const std::string& text)
{
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

template <class Whole>
std::optional<Whole> parse_whole(const std::string& text)
{
    Whole value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string bounds_text(const Bounds& bounds)
{
    std::vector<std::string> parts;
    if (std::isfinite(bounds.lowest)) parts.push_back(fmt::format("{} {}", bounds.lowest_included ? "at least" : "above", bounds.lowest));
    if (std::isfinite(bounds.highest)) parts.push_back(fmt::format("at most {}", bounds.highest));
    return fmt::format("{}", fmt::join(parts, " and "));
}

bool within(double value, const Bounds& bounds)
{
    return (value > bounds.lowest || (bounds.lowest_included && value == bounds.lowest)) && value <= bounds.highest;
}

std::string shown(const YAML::Node& node)
{
    if (node.IsScalar()) return fmt::format("'{}'", node.Scalar());
    if (node.IsSequence()) return "a list";
    if (node.IsMap()) return "a mapping";
    return "nothing";
}

}  // namespace

void Problems::add(const YAML::Mark& mark, std::string_view what)
{
    lines_.push_back({std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1, std::string{what}});
}

void Problems::add(std::string_view what)
{
    lines_.push_back({1, 1, std::string{what}});
}

std::string Problems::text() const
{
    auto lines = lines_;
    std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
        return std::pair{a.line, a.column} < std::pair{b.line, b.column};
    });
    std::string text;
    for (const auto& line : lines) text += fmt::format("{}:{}:{}: {}\n", file_, line.line, line.column, line.text);
    return text + fmt::format("{} problem{}, nothing started", lines.size(), lines.size() == 1 ? "" : "s");
}

Section::Section(YAML::Node node, std::string path, Problems& problems)
    : node_(node.IsDefined() ? node : YAML::Node{}), path_(std::move(path)), problems_(&problems)
{
    if (!node_.IsNull() && !node_.IsMap()) {
        problems_->add(node_.Mark(), fmt::format("{} must be a mapping of keys to values, got {}", path_, shown(node_)));
        node_.reset(YAML::Node{});
    }
}

std::string Section::name_of(std::string_view key) const
{
    return path_.empty() ? std::string{key} : fmt::format("{}.{}", path_, key);
}

YAML::Node Section::find(const char* key)
{
    asked_.emplace_back(key);
    const YAML::Node& node = node_;
    const auto value = node.IsMap() ? node[key] : YAML::Node{YAML::NodeType::Undefined};
    return value.IsDefined() && value.IsNull() ? YAML::Node{YAML::NodeType::Undefined} : value;
}

bool Section::has(const char* key)
{
    return find(key).IsDefined();
}

void Section::problem(const char* key, std::string_view what)
{
    const auto node = find(key);
    problems_->add(node.IsDefined() ? node.Mark() : node_.Mark(), fmt::format("{}: {}", name_of(key), what));
}

void Section::number(const char* key, double& value, const Bounds& bounds)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    const auto parsed = node.IsScalar() ? parse_number(node.Scalar()) : std::nullopt;
    const auto unit = bounds.unit.empty() ? std::string{} : fmt::format(" [{}]", bounds.unit);
    if (!parsed) problem(key, fmt::format("expected a number{}, got {}", unit, shown(node)));
    else if (!within(*parsed, bounds)) problem(key, fmt::format("must be {}{}, got {}", bounds_text(bounds), unit, node.Scalar()));
    else value = *parsed;
}

void Section::number(const char* key, std::optional<double>& value, const Bounds& bounds)
{
    if (!has(key)) return;
    double number_value = value.value_or(std::numeric_limits<double>::quiet_NaN());
    number(key, number_value, bounds);
    if (!std::isnan(number_value)) value = number_value;
}

void Section::whole(const char* key, std::uint32_t& value, std::uint32_t lowest, std::uint32_t highest)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    const auto parsed = node.IsScalar() ? parse_whole<std::uint32_t>(node.Scalar()) : std::nullopt;
    if (!parsed) problem(key, fmt::format("expected a whole number, got {}", shown(node)));
    else if (*parsed < lowest || *parsed > highest) problem(key, fmt::format("must be {} to {}, got {}", lowest, highest, *parsed));
    else value = *parsed;
}

void Section::whole(const char* key, std::uint64_t& value)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    const auto parsed = node.IsScalar() ? parse_whole<std::uint64_t>(node.Scalar()) : std::nullopt;
    if (parsed) value = *parsed;
    else problem(key, fmt::format("expected a whole number, got {}", shown(node)));
}

void Section::whole(const char* key, std::optional<unsigned>& value)
{
    if (!has(key)) return;
    std::uint32_t whole_value = 0;
    whole(key, whole_value);
    value = whole_value;
}

void Section::text(const char* key, std::string& value)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    if (node.IsScalar() && !node.Scalar().empty()) value = node.Scalar();
    else problem(key, fmt::format("expected a word, got {}", shown(node)));
}

void Section::boolean(const char* key, bool& value)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    const auto word = node.IsScalar() ? node.Scalar() : std::string{};
    if (word == "true" || word == "false") value = word == "true";
    else problem(key, fmt::format("expected true or false, got {}", shown(node)));
}

void Section::numbers(const char* key, std::vector<double>& value, const Bounds& bounds)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    if (!node.IsSequence()) {
        problem(key, fmt::format("expected a list of numbers, got {}", shown(node)));
        return;
    }
    value.clear();
    for (const auto& entry : node) {
        const auto parsed = entry.IsScalar() ? parse_number(entry.Scalar()) : std::nullopt;
        if (parsed && within(*parsed, bounds)) value.push_back(*parsed);
        else
            problems_->add(entry.Mark(), fmt::format("{}: expected a number{}{}, got {}", name_of(key),
                                                     bounds_text(bounds).empty() ? "" : " ", bounds_text(bounds), shown(entry)));
    }
}

void Section::texts(const char* key, std::vector<std::string>& value)
{
    const auto node = find(key);
    if (!node.IsDefined()) return;
    if (!node.IsSequence()) {
        problem(key, fmt::format("expected a list, got {}", shown(node)));
        return;
    }
    value.clear();
    for (const auto& entry : node) {
        if (entry.IsScalar()) value.push_back(entry.Scalar());
        else problems_->add(entry.Mark(), fmt::format("{}: expected words, got {}", name_of(key), shown(entry)));
    }
}

void Section::require(const char* key)
{
    if (!has(key)) problems_->add(node_.Mark(), fmt::format("{} is missing", name_of(key)));
}

Section Section::section(const char* key)
{
    return {find(key), name_of(key), *problems_};
}

std::vector<Section> Section::sections(const char* key)
{
    const auto node = find(key);
    std::vector<Section> result;
    if (!node.IsDefined()) return result;
    if (!node.IsSequence()) {
        problem(key, fmt::format("expected a list, got {}", shown(node)));
        return result;
    }
    for (std::size_t i = 0; i < node.size(); ++i) result.emplace_back(node[i], fmt::format("{}[{}]", name_of(key), i), *problems_);
    return result;
}

YAML::Node Section::raw(const char* key)
{
    return find(key);
}

void Section::finish()
{
    if (!node_.IsMap()) return;
    for (const auto& entry : node_) {
        const auto key = entry.first.IsScalar() ? entry.first.Scalar() : std::string{};
        if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
        const auto suggestion = nearest_word(key, asked_);
        problems_->add(entry.first.Mark(), fmt::format("unknown key '{}'{}{}", key, path_.empty() ? "" : " in " + path_,
                                                       suggestion.empty() ? "" : fmt::format("; did you mean '{}'?", suggestion)));
    }
}

tl::expected<void, std::string> assign(YAML::Node document, const std::string& assignment)
{
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        return tl::make_unexpected(fmt::format("'{}' is no assignment like source.speed=2", assignment));
    const bool append = assignment[equals - 1] == '+';
    std::string path = assignment.substr(0, append ? equals - 1 : equals);
    const auto value = YAML::Load(assignment.substr(equals + 1));
    YAML::Node node;
    node.reset(document);
    for (auto dot = path.find('.'); dot != std::string::npos; dot = path.find('.')) {
        node.reset(node[path.substr(0, dot)]);
        path.erase(0, dot + 1);
    }
    if (append) node[path].push_back(value);
    else node[path] = value;
    return {};
}

tl::expected<YAML::Node, std::string> load_yaml(const std::string& file)
{
    try {
        auto node = YAML::LoadFile(file);
        if (!node.IsMap())
            return tl::make_unexpected(fmt::format("{}:1:1: expected a mapping of keys to values\n1 problem, nothing started", file));
        return node;
    } catch (const YAML::ParserException& error) {
        return tl::make_unexpected(
            fmt::format("{}:{}:{}: {}\n1 problem, nothing started", file, error.mark.line + 1, error.mark.column + 1, error.msg));
    } catch (const YAML::BadFile&) {
        return tl::make_unexpected(fmt::format("{}: cannot be read", file));
    }
}

}  // namespace quorient::runtime
