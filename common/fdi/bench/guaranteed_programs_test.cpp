#include "guaranteed_comparison.hpp"
#include "guaranteed_frames.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gtest/gtest.h>

namespace quorient::fdi {
namespace {

void expect_the_same(const std::string& layout, std::uint64_t seed)
{
    const auto cluster = geometry::layout(layout).value();
    DetectorSettings settings;
    settings.bound = 1;
    settings.threshold = 10;
    const auto detector = GuaranteedDetector::make(settings, cluster).value();
    GuaranteedPrograms programs(cluster.axes, 1);
    const auto result = compare(*detector, programs, cluster.axes, 1, guaranteed_frames(cluster, 400, seed));
    EXPECT_EQ(result.emptiness_differs, 0U) << layout << ", seed " << seed;
    EXPECT_LT(result.largest_difference, 1e-6) << layout << ", seed " << seed;
    EXPECT_GT(result.empty, 10U) << "hardly any frame was empty";
    EXPECT_LT(result.at_the_boundary, 10U);
}

TEST(GuaranteedPrograms, give_the_same_intervals_as_the_closed_form)
{
    expect_the_same("guaranteed-cone", 21);
    expect_the_same("dodecahedron", 22);
}

}  // namespace
}  // namespace quorient::fdi
