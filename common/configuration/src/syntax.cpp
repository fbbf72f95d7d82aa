#include "syntax.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <vector>

namespace quorient::configuration {

namespace {

struct Wording {
    std::string_view yaml_cpp;
    std::string_view ours;
};

// How yaml-cpp's messages begin (0.8 ends one with the anchor's name), and what they mean to somebody who writes a file.
constexpr std::array wordings{
    Wording{"illegal map value",
            "a ':' that begins no value here: is the line before complete ('key: value', with a space), or the indentation "
            "deeper than its neighbours'? Text that holds ': ' needs quotes"},
    Wording{"end of map not found", "the indentation fits none of the lines above"},
    Wording{"end of sequence not found", "the indentation fits none of the lines above"},
    Wording{"end of map flow not found", "a '{' above is not closed by '}', or a ',' is missing"},
    Wording{"end of sequence flow not found", "a '[' above is not closed by ']', or a ',' is missing"},
    Wording{"unknown token", "a value cannot begin with this sign: write it in quotes"},
    Wording{"the referenced anchor is not defined",
            "'*' refers to an anchor that is not defined above; a text that begins with it needs quotes"},
    Wording{"illegal tab when looking for indentation", "a tab indents this line: YAML wants spaces"},
};

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

bool is_indented_by_tab(const std::string& line)
{
    const auto tab = line.find('\t');
    return tab != std::string::npos && line.find_first_not_of(" \t") > tab;
}

}  // namespace

SyntaxError syntax_error(const YAML::Exception& error, const std::string& text)
{
    SyntaxError found{std::max(error.mark.line, 0) + 1, std::max(error.mark.column, 0) + 1, error.msg};
    const auto lines = lines_of(text);
    const auto here = static_cast<std::size_t>(found.line - 1);
    if (here < lines.size() && is_indented_by_tab(lines[here])) {
        found.column = static_cast<int>(lines[here].find('\t')) + 1;
        found.text = "a tab indents this line: YAML wants spaces";
        return found;
    }
    const auto wording = std::ranges::find_if(wordings, [&](const Wording& each) { return error.msg.starts_with(each.yaml_cpp); });
    if (wording != wordings.end()) found.text = wording->ours;
    return found;
}

}  // namespace quorient::configuration
