#pragma once

#include <cstddef>
#include <fstream>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::cli {

struct CsvOptions {
    std::optional<std::size_t> columns = std::nullopt;  ///< in every row; absent: as many as the first row has
    bool allow_non_finite = false;                      ///< `nan` and `inf` are values
};

struct CsvRow {
    std::size_t line = 0;  ///< 1-based, in the file
    std::vector<double> value;
};

/// Rows of numbers, one at a time: cells separated by commas or white space, `#` starts a comment, blank lines are skipped,
/// a first row of words is a header: none of its cells is, or begins like, a number. Every error reads `file:line:column: what is wrong and what to do`
/// (1-based, columns count characters of the line).
class CsvReader {
public:
    /// @param path  a file, or `-` for standard input (`stdin` in errors).
    static tl::expected<CsvReader, std::string> open(const std::string& path, CsvOptions options = {});

    /// Reads from a stream that outlives the reader.
    CsvReader(std::istream& input, std::string name, CsvOptions options);

    /// The next row into `row` (its capacity is reused). @returns false at the end of the input.
    tl::expected<bool, std::string> next(CsvRow& row);

    /// Column names; empty where there is no header or no row was read yet.
    const std::vector<std::string>& header() const { return header_; }

    /// What to say of an input that has ended without a row: what was looked for, and what there was.
    std::string nothing() const;

    /// `name:line:column: what`, for problems that only the caller can see; column 0 = the line as a whole.
    std::string at(std::size_t line, std::size_t column, std::string_view what) const;

private:
    struct Cell {
        std::string_view text;
        std::size_t column = 1;
    };

    CsvReader(std::unique_ptr<std::ifstream> file, std::string name, CsvOptions options);
    tl::expected<void, std::string> split(std::string_view text);
    tl::expected<void, std::string> read_numbers(CsvRow& row) const;
    bool take_header();

    std::unique_ptr<std::ifstream> file_;  // where the reader owns its input
    std::istream* input_;
    std::string name_;
    CsvOptions options_;
    std::string text_;
    std::vector<Cell> cells_;
    std::vector<std::string> header_;
    std::size_t line_ = 0;
    bool expect_header_ = true;
};

/// All rows of a file, or of standard input for `-`.
tl::expected<std::vector<CsvRow>, std::string> read_csv(const std::string& path, CsvOptions options = {});

}  // namespace quorient::cli
