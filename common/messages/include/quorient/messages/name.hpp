#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace quorient {

/// A short name in a message: zero-terminated unless full.
template <std::size_t Size>
using Name = std::array<char, Size>;

/// Copies text into a name of a message; what does not fit is cut.
template <std::size_t Size>
void copy_text(std::string_view text, Name<Size>& name)
{
    name.fill('\0');
    std::copy_n(text.begin(), std::min(text.size(), Size - 1), name.begin());
}

/// The text in a name of a message, whatever a peer has put there.
template <std::size_t Size>
std::string_view text_of(const Name<Size>& name)
{
    return {name.data(), ::strnlen(name.data(), Size)};
}

}  // namespace quorient
