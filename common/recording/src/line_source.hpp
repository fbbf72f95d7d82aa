#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace quorient::recording {

/// The lines of a text file through one fixed buffer. Line ends are \n or \r\n.
class LineSource {
public:
    static constexpr std::size_t longest_line = 4096;

    explicit LineSource(const std::filesystem::path& file) : stream_(file, std::ios::binary) {}

    enum class Outcome { line, too_long, end };

    /// The next line without its end; valid until the next call. A line that is too long is passed over as a whole.
    Outcome next(std::string_view& line);

    /// 1-based, of the line given out last.
    std::uint64_t line_number() const { return line_number_; }

private:
    bool refill();
    std::optional<std::string_view> take_line();

    std::ifstream stream_;
    std::array<char, longest_line + 2> buffer_{};
    std::size_t begin_ = 0;  // start of what is not given out yet
    std::size_t end_ = 0;
    std::uint64_t line_number_ = 0;
};

/// The cells of a line, cut at commas (or, without any comma, at white space), blanks around each removed.
/// @returns how many there are; more than fit in `cells` are counted and not stored.
std::size_t split(std::string_view line, std::span<std::string_view> cells);

/// A number as from_chars reads it, `nan` and `inf` and a leading + included.
std::optional<double> number(std::string_view cell);

/// A text without blanks at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace quorient::recording
