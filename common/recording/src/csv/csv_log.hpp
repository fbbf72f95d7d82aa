#pragma once

#include "layout.hpp"
#include "line_source.hpp"
#include "rate_judge.hpp"

#include <map>

namespace quorient::recording::csv {

/// A table of gyro samples as people have it: wide (a row per time, columns of several instruments) or long (a row per instrument and time).
class CsvLog final : public InstrumentLog {
public:
    /// Reads as much of the log as it takes to understand it, all of it if nothing in its beginning shows its unit.
    /// @returns an error with the line, if the header names no gyro and time, or a unit cannot be determined.
    static tl::expected<std::unique_ptr<InstrumentLog>, std::string> open(Input input, std::string name, const LogOptions& options);

    ReadOutcome next(InstrumentSample& sample) override;
    double progress() const override { return lines_.progress(); }

private:
    /// What is remembered of one instrument of the table between its samples.
    struct Gyro {
        std::size_t place = 0;  ///< in instruments()
        std::optional<std::int64_t> stamp_ns;
        std::int64_t wraps_ns = 0;
        bool known = false;
    };

    CsvLog(Input input, std::string name, const LogOptions& options);
    std::optional<std::string> find_header();
    void read_units_row();
    std::optional<std::string> understand();
    std::optional<std::string> look_at_numbers(std::size_t rows);
    void look_at_points(std::size_t rows);
    std::optional<std::string> judge_times(std::size_t rows);
    void judge_accelerations();
    std::optional<std::string> judge_rates();
    void doubt_stated_unit();
    std::optional<std::string> apply_options();
    void to_first_row();
    bool next_row();
    std::optional<std::int64_t> time_of(const GyroColumns& gyro) const;
    std::optional<std::int64_t> row_time_of(const GyroColumns& gyro);
    std::optional<ReadOutcome> read(std::size_t gyro, InstrumentSample& sample);
    std::optional<ReadOutcome> read_values(const GyroColumns& gyro, InstrumentSample& sample, std::array<double, 3>& raw);
    Gyro* gyro_state(std::size_t gyro);
    Gyro* gyro_named(std::string_view key, std::size_t gyro);
    ReadOutcome refuse(std::string_view why);
    std::string_view cell(std::size_t place) const { return place < cells_.size() ? cells_[place] : std::string_view{}; }

    LineSource lines_;
    std::string name_;  // the file's
    LogOptions options_;
    Dialect dialect_;
    Layout layout_;
    std::uint64_t header_line_ = 0;
    std::size_t header_cells_ = 0;
    std::vector<std::string_view> cells_;       // the row in hand
    std::size_t next_gyro_ = 0;                 // next one of the row in hand
    const GyroColumns* timed_ = nullptr;        // whose time row_time_ns_ is, in the row in hand
    std::optional<std::int64_t> row_time_ns_;
    std::map<std::string, Gyro, std::less<>> gyros_;  // by identity in the long form, else by name
    std::vector<Gyro*> of_columns_;             // in the wide form by number: those of gyros_
    bool ended_ = false;
};

}  // namespace quorient::recording::csv
