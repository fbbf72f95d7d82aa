#pragma once

#include "quorient/recording/resampler.hpp"
#include "quorient/recording/survey.hpp"

#include <memory>

namespace quorient::recording {

/// The compared instruments of one log or several on common intervals, as a stream. Reads the logs a second time.
class AlignedLogs {
public:
    /// @param survey  with its clocks tied; at least one instrument is compared
    /// @param fastest_hz  most frames per second: faster instruments are integrated over several of their samples
    static tl::expected<AlignedLogs, std::string> open(const Survey& survey, double fastest_hz = 250.0);

    AlignedLogs(AlignedLogs&&) noexcept;
    AlignedLogs& operator=(AlignedLogs&&) noexcept;
    ~AlignedLogs();

    /// `rejected`: one record of a log was refused, problem() says what and where; go on reading.
    ReadOutcome next(AlignedFrame& frame);

    const std::string& problem() const;
    double interval_s() const;  ///< usual length of a frame
    double progress() const;

    /// Samples left out because their stamps left the line, by compared instrument.
    std::vector<std::uint64_t> dropped() const;

private:
    struct State;
    explicit AlignedLogs(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

}  // namespace quorient::recording
