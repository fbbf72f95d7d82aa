// The arrows of a state diagram in a README, to be compared with what the code does.
#pragma once

#include <fstream>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace quorient::test {

using Arrow = std::pair<std::string, std::string>;

/// @returns the arrows between states of the first mermaid state diagram in this file; the start `[*]` is no state.
inline std::set<Arrow> state_diagram(const std::string& file)
{
    std::ifstream page(file);
    if (!page) throw std::runtime_error("cannot read " + file);
    static const std::regex arrow(R"(\s*(\w+) --> (\w+): .+)");
    std::set<Arrow> arrows;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("stateDiagram")) inside = true;
        if (inside && line.starts_with("```")) break;
        if (std::smatch found; inside && std::regex_match(line, found, arrow)) arrows.emplace(found[1], found[2]);
    }
    return arrows;
}

}  // namespace quorient::test
