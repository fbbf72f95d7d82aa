#pragma once

#include <cstdint>
#include <optional>

namespace quorient::recording {

/// An axis that was at the end of its range, judged by its values alone.
struct Clipping {
    double range_rad_s = 0;     ///< magnitude that it did not pass
    std::uint64_t samples = 0;  ///< at that magnitude
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
};

/// One side of one axis. Motion seldom comes near the largest rate of a log and seldom stays there; a sensor at its range stays at one value, again and
/// again. A stuck axis stays there once, a spike does not stay.
class EndOfRange {
public:
    /// @param size magnitude of a finite rate on this side
    void add(double size_rad_s, std::int64_t time_ns);

    /// @returns nothing where the largest values look like motion
    std::optional<Clipping> clipping() const;

private:
    Clipping at_end_;
    std::uint64_t near_end_ = 0;  // samples close below it
    std::uint64_t visits_ = 0;
    bool there_ = false;
};

}  // namespace quorient::recording
