#pragma once

#include "quorient/recording/instrument_log.hpp"

#include <vector>

namespace quorient::recording {

/// Judges one instrument's stamps one by one, so that a clock that falls to another epoch and returns costs the samples in between and no
/// more. A stamp that leaves the line is doubted with those that follow it: if the line is taken up again they are dropped; if the new times
/// last for 3 s they are the line: a hole, where they lie ahead; a clock that was set back, where not, and its times then go on behind the
/// last good one. A line that was set back by a quarter of a second or more stays in doubt also where it passes the last good stamp.
class StampGuard {
public:
    explicit StampGuard(double period_s) : period_s_(period_s) {}

    /// Appends the samples that are good now: none, this one, or this one with those that were doubted.
    void add(const InstrumentSample& sample, std::vector<InstrumentSample>& good);

    /// The log has ended: what is doubted and lies ahead is good.
    void finish(std::vector<InstrumentSample>& good);

    std::uint64_t dropped() const { return dropped_; }

private:
    bool continues_set_back_line(const InstrumentSample& sample) const;
    void accept(const InstrumentSample& sample, std::vector<InstrumentSample>& good);
    void believe(std::vector<InstrumentSample>& good);
    void doubt(const InstrumentSample& sample);

    double period_s_;
    std::int64_t shift_ns_ = 0;  // that clocks set back are behind
    std::optional<std::int64_t> last_ns_;  // with the shift
    std::vector<InstrumentSample> doubted_;
    std::uint64_t dropped_ = 0;
};

}  // namespace quorient::recording
