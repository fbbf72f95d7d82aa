// No method may touch the heap per frame: every allocation of this program is counted.

#include "allocation_count.hpp"
#include "skewed_scene.hpp"
#include "quorient/fdi/methods.hpp"
#include "skewed/skewed_detector.hpp"
#include "test_clusters.hpp"

#include <gtest/gtest.h>

namespace quorient::fdi {
namespace {

struct Case {
    const char* method;
    const char* layout;
};

/// Healthy frames, one and two faults, a change of axes and back: every path that a frame can take.
std::size_t allocations_while_assessing(Detector& detector, const geometry::SensorCluster& cluster)
{
    std::vector<std::vector<double>> frames{measure(cluster, {1, 2, 3}), measure(cluster, {1, 2, 3}, {{1, 200}}),
                                            measure(cluster, {1, 2, 3}, {{0, 70}, {2, -300}})};
    Assessment assessment;
    std::uint64_t sequence = 0;
    const std::size_t before = quorient::test::allocation_count();
    for (int repetition = 0; repetition < 20; ++repetition)
        for (const auto& z : frames)
            for (const AxisMask valid : {cluster.all(), cluster.all() & ~axis_bit(3), cluster.all()})
                detector.assess({.identity = {1, sequence++}, .interval_s = 0.01, .increment = z, .valid = valid}, assessment);
    detector.exclude(axis_bit(1));
    detector.assess({.identity = {1, sequence++}, .interval_s = 0.01, .increment = frames[1], .valid = cluster.all()}, assessment);
    detector.exclude(0);
    return quorient::test::allocation_count() - before;
}

TEST(Allocation, is_counted_at_all)
{
    const std::size_t before = quorient::test::allocation_count();
    delete new double(1);
    const geometry::Axes on_the_stack = cluster_named("cone-4").axes;
    EXPECT_GT(quorient::test::allocation_count(), before);
    EXPECT_EQ(on_the_stack.rows(), 4);
}

TEST(Allocation, does_not_happen_per_frame_in_any_method)
{
    for (const Case& tried :
         {Case{"guaranteed", "dodecahedron"}, Case{"guaranteed", "octahedron-8"}, Case{"invariants", "dodecahedron"},
          Case{"invariants", "triads-8"}, Case{"voting", "dodecahedron"}, Case{"voting", "octahedron-8"}, Case{"mean", "dodecahedron"},
          Case{"mean", "triads-8"}, Case{"glt", "dodecahedron"}, Case{"glt", "triads-8"}, Case{"parity-set", "octahedron-8"},
          Case{"subset", "dodecahedron"}, Case{"subset", "triads-8"}, Case{"extrapolation", "cone-4"}, Case{"vector", "cone-4"}}) {
        DetectorSettings settings;
        settings.method = tried.method;
        settings.sigma = 1;
        settings.bound = 4;
        const auto cluster = cluster_named(tried.layout);
        const auto detector = make_detector(settings, cluster).value();
        EXPECT_EQ(allocations_while_assessing(*detector, cluster), 0U) << tried.method << " on " << tried.layout;
    }
}

TEST(Allocation, does_not_happen_per_frame_in_the_field_detector)
{
    for (const Mount mount : {Mount::board, Mount::structure}) {
        FieldScene scene(8, 1);
        scene.spoil = [](std::uint64_t sequence, FieldScene::Rates& rates) {
            if (sequence > 600) rates[4] += 10;
            if (sequence > 700 && sequence < 720) rates[9] = std::nan("");
        };
        scene.next();
        const auto detector = make_detector({.method = "field", .mount = mount}, scene.cluster).value();
        Assessment assessment;
        std::size_t named = 0;
        const std::size_t before = quorient::test::allocation_count();
        for (int frame = 0; frame < 800; ++frame) {
            detector->assess(scene.next(), assessment);
            named += assessment.outcome == Outcome::isolated ? 1 : 0;
        }
        detector->exclude(axes_of(1));
        for (int frame = 0; frame < 100; ++frame) detector->assess(scene.next(), assessment);
        detector->exclude(0);
        for (int frame = 0; frame < 200; ++frame) detector->assess(scene.next(), assessment);
        EXPECT_EQ(quorient::test::allocation_count() - before, 0U);
        EXPECT_GT(named, 0U);
    }
}

TEST(Allocation, does_not_happen_per_frame_in_the_field_detector_of_single_axes)
{
    for (const char* layout : {"cone-5", "octahedron-8", "triads-8"}) {
        SkewedScene scene(layout, 1);
        scene.spoil = [](std::uint64_t sequence, SkewedScene::Rates& rates) {
            if (sequence > 600) rates[1] += 20;
            if (sequence > 700 && sequence < 720) rates[3] = std::nan("");
        };
        scene.next();
        const auto detector = SkewedDetector::make({}, scene.cluster).value();
        Assessment assessment;
        std::size_t named = 0;
        const std::size_t before = quorient::test::allocation_count();
        for (int frame = 0; frame < 800; ++frame) {
            detector->assess(scene.next(), assessment);
            named += assessment.outcome != Outcome::healthy ? 1 : 0;
        }
        detector->exclude(axis_bit(1));
        for (int frame = 0; frame < 100; ++frame) detector->assess(scene.next(), assessment);
        detector->exclude(0);
        for (int frame = 0; frame < 200; ++frame) detector->assess(scene.next(), assessment);
        EXPECT_EQ(quorient::test::allocation_count() - before, 0U) << layout;
        EXPECT_GT(named, 100U) << layout;
    }
}

TEST(Allocation, does_not_happen_per_frame_for_instruments)
{
    DetectorSettings settings;
    settings.method = "subset";
    settings.sigma = 1;
    settings.instruments = true;
    const auto cluster = cluster_named("triads-8");
    const auto detector = make_detector(settings, cluster).value();
    EXPECT_EQ(allocations_while_assessing(*detector, cluster), 0U);
}

}  // namespace
}  // namespace quorient::fdi
