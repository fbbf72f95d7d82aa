#include "quorient/configuration/problems.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <tuple>

namespace quorient::configuration {

namespace {

bool is_beneath(std::string_view key, std::string_view parent)
{
    return key.starts_with(parent) && (key.size() == parent.size() || key[parent.size()] == '.' || key[parent.size()] == '[');
}

}  // namespace

void Problems::add(const YAML::Mark& mark, std::string_view key, std::string_view text)
{
    const bool elsewhere = std::ranges::any_of(replaced_, [&](const auto& entry) { return is_beneath(key, entry.first); });
    Problem problem{std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1, std::string{key}, std::string{text}};
    if (elsewhere) problem.line = problem.column = 0;
    const bool known = std::ranges::any_of(problems_, [&](const Problem& other) {
        return std::tie(other.line, other.column, other.text) == std::tie(problem.line, problem.column, problem.text);
    });
    if (!known) problems_.push_back(std::move(problem));
}

void Problems::add(std::string_view text)
{
    problems_.push_back({0, 0, {}, std::string{text}});
}

void Problems::replaced(std::string key, std::string said)
{
    replaced_.emplace_back(std::move(key), std::move(said));
}

std::vector<Problem> Problems::all() const
{
    auto ordered = problems_;
    std::ranges::stable_sort(ordered, {}, [](const Problem& problem) { return std::pair{problem.line, problem.column}; });
    return ordered;
}

std::string Problems::place_of(const Problem& problem) const
{
    if (problem.line > 0) return fmt::format("{}:{}:{}", file_, problem.line, problem.column);
    const auto said = std::ranges::find_if(replaced_, [&](const auto& entry) { return is_beneath(problem.key, entry.first); });
    return said != replaced_.end() && !problem.key.empty() ? said->second : file_;
}

std::string Problems::lines() const
{
    std::string text;
    for (const auto& problem : all()) text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", place_of(problem), problem.text);
    return text;
}

std::string Problems::text() const
{
    return fmt::format("{}\n{} problem{}, nothing started", lines(), problems_.size(), problems_.size() == 1 ? "" : "s");
}

}  // namespace quorient::configuration
