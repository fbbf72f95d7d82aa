#pragma once

#include <yaml-cpp/mark.h>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quorient::configuration {

/// One thing that is wrong with a file.
struct Problem {
    int line = 0;  ///< from 1; 0 where the value does not stand in the file
    int column = 0;
    std::string key;   ///< "lanes[1].detector.method"; empty where the trouble is not about one key
    std::string text;  ///< a sentence that names the key
};

/// All that is wrong with a file, each with its place; collected so that a user mends everything at once.
class Problems {
public:
    explicit Problems(std::string file) : file_(std::move(file)) {}

    /// A problem that is known already is not added again.
    void add(const YAML::Mark& mark, std::string_view key, std::string_view text);

    /// What is wrong as a whole, e.g. with an assignment.
    void add(std::string_view text);

    /// The value of this key, and what is beneath it, does not stand in the file but was `said`: problems with it name that as their place.
    void replaced(std::string key, std::string said);

    bool empty() const { return problems_.empty(); }
    std::size_t count() const { return problems_.size(); }

    /// In the order of the file.
    std::vector<Problem> all() const;

    /// One line for each problem: `file:line:column: text`.
    std::string lines() const;

    /// The lines, then how many, and that nothing was started.
    std::string text() const;

private:
    std::string place_of(const Problem& problem) const;

    std::string file_;
    std::vector<Problem> problems_;
    std::vector<std::pair<std::string, std::string>> replaced_;
};

}  // namespace quorient::configuration
