#include "quorient/configuration/document.hpp"

#include "syntax.hpp"

#include <fmt/format.h>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

namespace quorient::configuration {

namespace {

constexpr std::size_t most_megabytes = 16;

/// Reads at most so much, so that an endless file (/dev/zero) is refused.
tl::expected<std::string, std::string> content_of(const std::string& file)
{
    std::error_code unknown;
    if (std::filesystem::is_directory(file, unknown)) return tl::unexpected(std::string("is a directory, expected a file"));
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return tl::unexpected(fmt::format("cannot be read: {}", std::strerror(errno)));
    std::string text;
    std::array<char, 4096> part{};
    while (stream.read(part.data(), part.size()), stream.gcount() > 0) {
        text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > most_megabytes << 20U) return tl::unexpected(fmt::format("cannot be read: more than {} MB", most_megabytes));
    }
    if (stream.bad()) return tl::unexpected(std::string("cannot be read to its end"));
    return text;
}

tl::unexpected<Problems> only(const std::string& name, std::string_view what)
{
    Problems problems{name};
    problems.add(what);
    return tl::unexpected(problems);
}

tl::unexpected<Problems> only(const std::string& name, int line, int column, std::string_view what)
{
    Problems problems{name};
    YAML::Mark mark;
    mark.line = line - 1;
    mark.column = column - 1;
    problems.add(mark, {}, what);
    return tl::unexpected(problems);
}

/// "lanes[0].detector" -> lanes, 0, detector
std::vector<std::string> steps_of(std::string_view path)
{
    std::vector<std::string> steps(1);
    for (const char letter : path) {
        if (letter == '.' || letter == '[') steps.emplace_back();
        else if (letter != ']') steps.back() += letter;
    }
    return steps;
}

std::optional<std::size_t> number_of(const std::string& step)
{
    std::size_t number = 0;
    const auto* const end = step.data() + step.size();
    const auto read = std::from_chars(step.data(), end, number);
    return !step.empty() && read.ec == std::errc{} && read.ptr == end ? std::optional(number) : std::nullopt;
}

/// An item of a list by its number, or by its name.
std::optional<std::size_t> item_of(const YAML::Node& list, const std::string& step)
{
    if (const auto number = number_of(step)) return *number < list.size() ? number : std::nullopt;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const YAML::Node item = list[i];
        if (item.IsMap() && item["name"] && item["name"].IsScalar() && item["name"].Scalar() == step) return i;
    }
    return std::nullopt;
}

}  // namespace

tl::expected<YAML::Node, Problems> parse_yaml(const std::string& text, const std::string& name)
{
    try {
        const auto documents = YAML::LoadAll(text);
        if (documents.size() > 1) return only(name, fmt::format("holds {} documents divided by '---', expected one", documents.size()));
        if (documents.empty() || documents.front().IsNull()) return only(name, "is empty, expected keys and values");
        if (!documents.front().IsMap()) return only(name, 1, 1, "expected a mapping of keys to values");
        return documents.front();
    } catch (const YAML::Exception& error) {  // yaml-cpp's only way to report a syntax error
        const auto found = syntax_error(error, text);
        return only(name, found.line, found.column, found.text);
    }
}

tl::expected<YAML::Node, Problems> load_yaml(const std::string& file)
{
    const auto text = content_of(file);
    if (!text) return only(file, text.error());
    return parse_yaml(*text, file);
}

tl::expected<Assignment, std::string> parse_assignment(const std::string& text)
{
    const auto equals = text.find('=');
    const bool append = equals != std::string::npos && equals > 0 && text[equals - 1] == '+';
    const auto path = text.substr(0, append ? equals - 1 : equals);
    if (equals == std::string::npos || path.empty()) return tl::unexpected(fmt::format("'{}' is no assignment like source.speed=2", text));
    return Assignment{path, text.substr(equals + 1), append};
}

namespace {

/// Goes one step down, and makes the key where it is not there. `path` grows by the step, items by their number.
tl::expected<void, std::string> descend(YAML::Node& node, const std::string& step, std::string& path)
{
    if (node.IsSequence()) {
        const auto item = item_of(node, step);
        if (!item) return tl::unexpected(fmt::format("there is no item '{}' in '{}'", step, path));
        path += fmt::format("[{}]", *item);
        node.reset(node[*item]);
        return {};
    }
    if (node.IsScalar()) return tl::unexpected(fmt::format("'{}' is a value, and has no '{}'", path, step));
    path += (path.empty() ? "" : ".") + step;
    node.reset(node[step]);
    return {};
}

}  // namespace

tl::expected<std::string, std::string> assign(YAML::Node document, const Assignment& assignment)
{
    const auto refused = [&](std::string_view why) {
        return tl::unexpected(fmt::format("{}{}={}: {}", assignment.path, assignment.append ? "+" : "", assignment.value, why));
    };
    try {
        const auto value = YAML::Load(assignment.value);
        YAML::Node node;
        node.reset(document);
        std::string path;
        for (const auto& step : steps_of(assignment.path))
            if (const auto done = descend(node, step, path); !done) return refused(done.error());
        if (!assignment.append) {
            node = value;
            return path;
        }
        if (node.IsMap() || node.IsScalar()) return refused("is no list to append to");
        node.push_back(value);
        return fmt::format("{}[{}]", path, node.size() - 1);
    } catch (const YAML::Exception& error) {
        return refused(syntax_error(error, assignment.value).text);
    }
}

tl::expected<std::string, std::string> assign(YAML::Node document, const std::string& assignment)
{
    const auto parsed = parse_assignment(assignment);
    if (!parsed) return tl::unexpected(parsed.error());
    return assign(document, *parsed);
}

namespace {

/// The node of the longest part of a path that stands in the document. @returns it, and whether that is the whole path
std::pair<YAML::Node, bool> follow(const YAML::Node& document, std::string_view path)
{
    YAML::Node node;
    node.reset(document);
    for (const auto& step : steps_of(path)) {
        const YAML::Node& here = node;  // reading through a constant node adds nothing to the document
        const auto number = number_of(step);
        const bool is_list = here.IsSequence() && number;
        if (!is_list && !here.IsMap()) return {node, false};
        const YAML::Node next = is_list ? here[*number] : here[step];
        if (!next.IsDefined() || next.IsNull()) return {node, false};
        node.reset(next);
    }
    return {node, true};
}

}  // namespace

YAML::Mark place_of(const YAML::Node& document, std::string_view path)
{
    return follow(document, path).first.Mark();
}

bool stands(const YAML::Node& document, std::string_view path)
{
    return follow(document, path).second;
}

void report(Problems& problems, const YAML::Node& document, std::string_view path, std::string_view what)
{
    problems.add(place_of(document, path), path, fmt::format("{}: {}", path, what));
}

}  // namespace quorient::configuration
