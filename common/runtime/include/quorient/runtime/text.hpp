#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::runtime {

/// Copies text into a name of a message; what does not fit is cut.
template <std::size_t Size>
void copy_text(std::string_view text, std::array<char, Size>& name)
{
    name.fill('\0');
    std::copy_n(text.begin(), std::min(text.size(), Size - 1), name.begin());
}

/// The text in a name of a message, from whoever sent it.
template <std::size_t Size>
std::string_view text_of(const std::array<char, Size>& name)
{
    return {name.data(), ::strnlen(name.data(), Size)};
}

/// Of the words, the one that is fewest edits away from `word`; empty if none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

/// "axis 1 (G2)", "axes 1 (G2), 3 (G4)"; "no axis" for an empty mask.
std::string describe_axes(std::uint32_t mask);

}  // namespace quorient::runtime
