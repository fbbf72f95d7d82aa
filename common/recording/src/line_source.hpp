#pragma once

#include "bytes/input.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace quorient::recording {

/// The lines of a text through one buffer. Line ends are \n or \r\n.
class LineSource {
public:
    /// @param longest_line  bytes; exports with hundreds of columns have long ones
    explicit LineSource(Input input, std::size_t longest_line = 1U << 16U) : input_(std::move(input)), longest_line_(longest_line) {}

    enum class Outcome { line, too_long, end };

    /// The next line without its end; valid until the next call. A line that is too long is passed over as a whole.
    Outcome next(std::string_view& line);

    /// 1-based, of the line given out last.
    std::uint64_t line_number() const { return line_number_; }

    void rewind();
    double progress() const { return input_.progress(); }
    const std::string& trouble() const { return input_.trouble(); }

private:
    Input input_;
    std::size_t longest_line_;
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
