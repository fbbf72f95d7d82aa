#include "quorient/configuration/suggestion.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>

namespace quorient::configuration {

namespace {

/// Levenshtein distance.
std::size_t edits(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

constexpr std::size_t shortest_beginning = 3;

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& words)
{
    const auto nearest =
        std::min_element(words.begin(), words.end(), [&](const auto& a, const auto& b) { return edits(word, a) < edits(word, b); });
    if (nearest != words.end() && edits(word, *nearest) <= 1 + word.size() / 3) return *nearest;
    const auto longer = std::find_if(words.begin(), words.end(), [&](const auto& known) { return known.starts_with(word); });
    return word.size() >= shortest_beginning && longer != words.end() ? *longer : std::string{};
}

std::string suggestion(std::string_view word, const std::vector<std::string>& words)
{
    const auto nearest = nearest_word(word, words);
    return nearest.empty() ? std::string{} : fmt::format("; did you mean '{}'?", nearest);
}

std::string listed(const std::vector<std::string>& words)
{
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
    return text;
}

}  // namespace quorient::configuration
