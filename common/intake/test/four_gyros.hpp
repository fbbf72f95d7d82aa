#pragma once

#include "quorient/messages/meaning.hpp"

#include <cstdint>

namespace quorient::intake::test {

inline constexpr std::uint32_t unit = 7;
inline constexpr std::int64_t interval_ns = 5'000'000;

/// Four gyros at 200 Hz.
inline ClusterDescription description(std::uint64_t epoch, std::uint32_t revision = 1)
{
    ClusterDescription described;
    described.epoch = epoch;
    described.revision = revision;
    described.unit = unit;
    described.kind = octet(SensorKind::gyro);
    described.axis_count = 4;
    described.interval_s = 0.005;
    return described;
}

/// A frame of theirs as it should be, at its time.
inline SensorFrame frame(std::uint64_t epoch, std::uint64_t sequence)
{
    SensorFrame made;
    made.epoch = epoch;
    made.sequence = sequence;
    made.sample_time_ns = static_cast<std::int64_t>(sequence + 1) * interval_ns;
    made.interval_s = 0.005;
    made.unit = unit;
    made.kind = octet(SensorKind::gyro);
    made.axis_count = 4;
    made.valid_mask = all_axes(4);
    made.description_revision = 1;
    return made;
}

}  // namespace quorient::intake::test
