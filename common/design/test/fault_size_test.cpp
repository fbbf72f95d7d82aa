#include "quorient/design/fault_size.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/geometry/layouts.hpp"

#include <Eigen/QR>
#include <gtest/gtest.h>
#include <cmath>
#include <random>

namespace quorient::design {
namespace {

FaultSizes sizes(const char* layout)
{
    return fault_sizes(geometry::ParitySpace(geometry::layout(layout)->axes), {});
}

// docs/methods: what a single frame can show at all, P_fa 1e-6, P_d 0.99.
TEST(DetectedSize, is_that_of_the_published_table)
{
    EXPECT_NEAR(sizes("orthogonal-3-plus-1").detected_axis, 17.7, 0.05);
    EXPECT_NEAR(sizes("cone-4").detected_axis, 14.4, 0.05);
    EXPECT_NEAR(sizes("cone-5").detected_axis, 11.9, 0.05);
    EXPECT_NEAR(sizes("dodecahedron").detected_axis, 10.9, 0.05);
    EXPECT_NEAR(sizes("triads-8").detected_axis, 10.0, 0.05);
}

TEST(FaultSizes, are_infinite_where_nothing_can_tell)
{
    EXPECT_TRUE(std::isinf(sizes("orthogonal-3").detected_axis));
    EXPECT_TRUE(std::isinf(sizes("cone-4").isolated_axis));
    EXPECT_TRUE(std::isinf(sizes("triads-2").isolated_axis));
    EXPECT_TRUE(std::isinf(sizes("cone-4").detected_pair));
    EXPECT_TRUE(std::isinf(sizes("dodecahedron").isolated_pair));
    EXPECT_TRUE(std::isfinite(sizes("cone-8").isolated_pair));
}

TEST(FaultSizes, scale_with_the_noise_of_the_axes)
{
    const auto axes = geometry::layout("dodecahedron")->axes;
    const FaultSizes half = fault_sizes(geometry::ParitySpace(geometry::Axes(2 * axes)), {});
    EXPECT_NEAR(half.detected_axis, sizes("dodecahedron").detected_axis, 1e-9);  // in sigma of the axis
}

/// How often the likelihood ratio test names the axis, of faults of this size on it: the real detector on random frames.
double named(const geometry::SensorCluster& cluster, std::size_t axis, double size, double false_alarm, int trials, std::mt19937_64& random)
{
    fdi::DetectorSettings settings;
    settings.method = "glt";
    settings.sigma = 1;
    settings.pfa = false_alarm;
    settings.margin = 0;
    const auto detector = fdi::make_detector(settings, cluster).value();
    std::normal_distribution<double> normal;
    std::vector<double> z(cluster.size());
    int right = 0;
    for (int trial = 0; trial < trials; ++trial) {
        for (double& value : z) value = normal(random);
        z[axis] += size;
        fdi::Assessment assessment;
        detector->assess({.identity = {1, static_cast<std::uint64_t>(trial)}, .interval_s = 1, .increment = z, .valid = cluster.all()}, assessment);
        // `blind`: what is left exceeds its own limit, rarely; the axis that explains most is what counts here.
        right += assessment.isolated == axis_bit(axis) && assessment.outcome == fdi::Outcome::isolated ? 1 : 0;
    }
    return static_cast<double>(right) / trials;
}

TEST(IsolationProbability, is_that_of_the_likelihood_ratio_test_and_never_above)
{
    constexpr unsigned seed = 4;
    constexpr int trials = 20'000;
    std::mt19937_64 random(seed);
    for (const char* layout : {"cone-5", "cone-6", "dodecahedron", "cone-8"}) {
        const auto cluster = geometry::layout(layout).value();
        const geometry::ParitySpace space(cluster.axes);
        for (const double size : {8.0, 10.0, 13.0}) {
            const double reckoned = isolation_probability(space, 0, size, 1e-4);
            const double counted = named(cluster, 0, size, 1e-4, trials, random);
            const double error = std::sqrt(counted * (1 - counted) / trials) + 1e-4;
            EXPECT_LT(reckoned, counted + 4 * error) << layout << ", size " << size << ", seed " << seed;
            // The sum over rivals counts some wrong answers twice: a sixth of them at most here.
            EXPECT_LT(1 - reckoned, (1 - counted) * 7 / 6 + 4 * error) << layout << ", size " << size << ", seed " << seed;
        }
    }
}

TEST(IsolatedSize, is_where_that_probability_is_reached_on_the_worst_axis)
{
    const geometry::ParitySpace five(geometry::layout("cone-5")->axes);
    const double size = isolated_axis(five, {});
    EXPECT_NEAR(isolation_probability(five, 0, size, 1e-6), 0.99, 1e-6);
    EXPECT_GT(isolation_probability(five, 0, 1.02 * size, 1e-6), 0.99);
    EXPECT_GE(size, detected_axis(five, {}));
}

// On eight axes of a cone: the two hypotheses that are hardest to tell, played.
TEST(IsolatedPair, is_where_the_nearest_rival_pair_is_mistaken_once_in_a_hundred)
{
    const auto axes = geometry::layout("cone-8")->axes;
    const geometry::ParitySpace space(axes);
    const double size = isolated_pair(space, {});
    const auto& v = space.basis();
    double nearest = 1e9;
    for (int i = 0; i < 8; ++i)
        for (int j = i + 1; j < 8; ++j)
            for (int k = 0; k < 8; ++k)
                for (int l = k + 1; l < 8; ++l)
                    for (const double sign : {-1.0, 1.0}) {
                        if (i == k && j == l) continue;
                        const Eigen::VectorXd fault = v.col(i) + sign * v.col(j);
                        Eigen::MatrixXd rival(5, 2);
                        rival << v.col(k), v.col(l);
                        const Eigen::VectorXd left = fault - rival * rival.colPivHouseholderQr().solve(fault);
                        nearest = std::min(nearest, left.norm());
                    }
    EXPECT_NEAR(size * nearest / 2, 2.3263478740, 1e-6);  // the normal quantile of 0.99
}

}  // namespace
}  // namespace quorient::design
