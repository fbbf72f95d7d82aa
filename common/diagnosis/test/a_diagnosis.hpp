#pragma once

#include "scene_frames.hpp"

#include <gtest/gtest.h>
#include <cstdint>

namespace quorient::diagnosis {

inline constexpr double length_s = 30;
inline constexpr double onset_s = 8;

/// Calls spoil(rate of this axis in deg/s) on one axis from the onset on.
template <class Spoil>
void spoil_axis(fdi::FieldScene& scene, std::size_t axis, Spoil spoil, double from_s = onset_s, double to_s = 1e9)
{
    const double interval_s = scene.cluster.interval_s;
    scene.spoil = [=](std::uint64_t sequence, fdi::FieldScene::Rates& rates) mutable {
        const double time_s = static_cast<double>(sequence) * interval_s;
        if (time_s >= from_s && time_s < to_s) rates[axis] = spoil(rates[axis]);
    };
}

/// The weightiest finding, which must be certain and of this instrument, and no certain one of any other.
inline Finding only_of(std::size_t instrument, const Report& report)
{
    const auto isolated = with(report, Certainty::isolated);
    if (isolated.empty()) {
        ADD_FAILURE() << "nothing isolated: " << report.sentence;
        return {};
    }
    for (const Finding& finding : isolated) EXPECT_EQ(finding.instrument, instrument) << report.sentence;
    return isolated.front();
}

class ADiagnosis : public testing::TestWithParam<std::uint64_t> {
protected:
    fdi::FieldScene scene{3, GetParam()};
};

}  // namespace quorient::diagnosis
