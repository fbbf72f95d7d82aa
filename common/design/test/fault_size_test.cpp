#include "quorient/design/fault_size.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/geometry/layouts.hpp"

#include <Eigen/QR>
#include <boost/math/distributions/chi_squared.hpp>
#include <gtest/gtest.h>
#include <algorithm>
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

// The probability of isolation is 1 minus a sum: that the fault is not detected, and for each rival that it explains more. Played frame by
// frame, with the events decided from the residual alone, the mean number of events is that sum itself. It is compared within 4 standard
// errors of the Monte Carlo (two-sided 6e-5, so 8e-4 for the twelve cases of a seed); no other margin is in it.

/// What the frames of one fault came to.
struct Played {
    double events = 0;            ///< mean number of the ways to go wrong in a frame
    double events_error = 0;      ///< its standard error
    double wrong = 0;             ///< share of frames in which any of them happened
    double wrong_error = 0;       ///< its standard error (binomial)
    double disagreeing = 0;       ///< share of frames in which the real detector named the axis, and an event happened, or the other way round
};

unsigned events_of(const geometry::AxisMatrix& projector, const Eigen::VectorXd& residual, Eigen::Index axis, double limit)
{
    const auto explained = [&](Eigen::Index i) { return residual(i) * residual(i) / projector(i, i); };
    unsigned events = residual.squaredNorm() > limit ? 0 : 1;
    for (Eigen::Index rival = 0; rival < residual.size(); ++rival)
        if (rival != axis && explained(rival) > explained(axis)) ++events;
    return events;
}

Played played(const geometry::SensorCluster& cluster, std::size_t axis, double size, double false_alarm, int trials, std::mt19937_64& random)
{
    fdi::DetectorSettings settings;
    settings.method = "glt";
    settings.sigma = 1;
    settings.pfa = false_alarm;
    settings.margin = 0;
    const auto detector = fdi::make_detector(settings, cluster).value();
    const geometry::AxisMatrix projector = geometry::ParitySpace(cluster.axes).projector();
    const boost::math::chi_squared quiet(static_cast<double>(cluster.size() - 3));
    const double limit = boost::math::quantile(boost::math::complement(quiet, false_alarm));
    std::normal_distribution<double> normal;
    Eigen::VectorXd z(static_cast<Eigen::Index>(cluster.size()));
    double sum = 0, squares = 0, wrong = 0, disagreeing = 0;
    for (int trial = 0; trial < trials; ++trial) {
        for (double& value : z) value = normal(random);
        z(static_cast<Eigen::Index>(axis)) += size;
        const unsigned events = events_of(projector, projector * z, static_cast<Eigen::Index>(axis), limit);
        sum += events;
        squares += events * events;
        wrong += events > 0 ? 1 : 0;
        fdi::Assessment assessment;
        detector->assess({.identity = {1, static_cast<std::uint64_t>(trial)},
                          .interval_s = 1,
                          .increment = {z.data(), cluster.size()},
                          .valid = cluster.all()},
                         assessment);
        const bool named = assessment.isolated == axis_bit(axis) && assessment.outcome == fdi::Outcome::isolated;
        disagreeing += named != (events == 0) ? 1 : 0;
    }
    Played result{sum / trials, 0, wrong / trials, 0, disagreeing / trials};
    result.events_error = std::sqrt((squares / trials - result.events * result.events) / trials);
    result.wrong_error = std::sqrt(result.wrong * (1 - result.wrong) / trials);
    return result;
}

TEST(IsolationProbability, sums_the_ways_to_go_wrong_and_is_never_above_what_the_detector_does)
{
    constexpr unsigned seed = 4;
    constexpr int trials = 100'000;
    constexpr double false_alarm = 1e-4, confidence = 4;
    std::mt19937_64 random(seed);
    for (const char* layout : {"cone-5", "cone-6", "dodecahedron", "cone-8"}) {
        const auto cluster = geometry::layout(layout).value();
        const geometry::ParitySpace space(cluster.axes);
        for (const double size : {8.0, 10.0, 13.0}) {
            const double sum = 1 - isolation_probability(space, 0, size, false_alarm);
            const Played frames = played(cluster, 0, size, false_alarm, trials, random);
            const double one_frame = 1.0 / trials;  // where hardly any event happens, its standard error is not known better
            EXPECT_NEAR(sum, frames.events, confidence * std::max(frames.events_error, one_frame))
                << layout << ", size " << size << ", seed " << seed;
            EXPECT_GT(sum, frames.wrong - confidence * std::max(frames.wrong_error, one_frame)) << layout << ", size " << size << ", seed " << seed;
            // The detector also refuses frames whose rest exceeds the limit without the axis: at most false_alarm of them.
            const double refused = false_alarm + confidence * std::sqrt(false_alarm / trials);
            EXPECT_LT(frames.disagreeing, refused) << layout << ", size " << size << ", seed " << seed;
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

// On eight axes of a cone: the two hypotheses that are hardest to distinguish, played.
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
