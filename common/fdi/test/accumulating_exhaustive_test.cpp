#include "arrays/accumulating_detector.hpp"
#include "quorient/fdi/noise.hpp"
#include "test_clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace quorient::fdi {
namespace {

// At rest, with triads of one noise and no noise of motion, all that the detector reckons is a sum of increments over a window:
// here every window that is due and every hypothesis are tried, one after another, by that formula alone. The detector leaves out what
// cannot change its finding; it must find the same.

constexpr double interval_s = 0.016;
constexpr double sigma = 1e-4;
constexpr double margin = 1.25;
constexpr double false_alarms_per_hour = 0.1;
constexpr double alert_level = 0.7;
constexpr double contradicting_level = 0.9;
constexpr std::array<std::size_t, 18> windows{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512};

struct Suspect {
    double certainty = 0;
    AxisMask axes = 0;
};

struct Judgement {
    Suspect most;
    Suspect rival;
    bool contradicted = false;  ///< isolated, but for the word of another window

    bool found() const { return most.certainty > 1; }
    bool isolated() const { return found() && most.certainty >= margin * rival.certainty; }
};

class Exhaustive {
public:
    Exhaustive(const geometry::SensorCluster& cluster, bool instruments) : cluster_(cluster), instruments_(instruments)
    {
        const double hypotheses = static_cast<double>(cluster.size()) * 4 / 3;
        for (const std::size_t window : windows) {
            const double looks_per_hour = 3600 / interval_s / static_cast<double>(stride_of(window));
            const double tail = false_alarms_per_hour / (static_cast<double>(windows.size()) * looks_per_hour * hypotheses);
            limits_.push_back({.axis = chi_square_quantile(1, tail), .instrument = chi_square_quantile(3, tail)});
        }
    }

    Judgement add(const std::vector<double>& increment)
    {
        Eigen::Matrix3Xd sum = sums_.empty() ? Eigen::Matrix3Xd::Zero(3, instrument_count()) : sums_.back();
        for (Eigen::Index m = 0; m < instrument_count(); ++m)
            for (Eigen::Index i = 3 * m; i < 3 * m + 3; ++i)
                sum.col(m) += cluster_.axes.row(i).transpose() * increment[static_cast<std::size_t>(i)];
        sums_.push_back(sum);
        const std::size_t counted = sums_.size() - 1;  // the newest frame waits for its successor
        if (counted < 2) return {};
        const Judgement judgement = over_all_windows(counted);
        alert_ = judgement.most.certainty > alert_level;
        return judgement;
    }

private:
    struct Limits {
        double axis;
        double instrument;
    };

    static std::size_t stride_of(std::size_t window) { return std::max<std::size_t>(1, window / 8); }

    Eigen::Index instrument_count() const { return cluster_.axes.rows() / 3; }

    Judgement over_all_windows(std::size_t counted) const
    {
        Judgement most;
        std::vector<Suspect> suspects;
        for (std::size_t i = 0; i < windows.size(); ++i) {
            if (windows[i] >= counted || (!alert_ && counted % stride_of(windows[i]) != 0)) continue;
            const Judgement here = over_one(windows[i], counted, limits_[i]);
            suspects.push_back(here.most);
            if (here.most.certainty > most.most.certainty) most = here;
        }
        const bool isolated_alone = most.isolated();
        for (const Suspect& other : suspects)
            if (other.certainty > contradicting_level && other.axes != most.most.axes && other.certainty > most.rival.certainty)
                most.rival = other;
        most.contradicted = isolated_alone && !most.isolated();
        return most;
    }

    Judgement over_one(std::size_t window, std::size_t counted, const Limits& limits) const
    {
        const auto n = static_cast<double>(instrument_count());
        const double variance = sigma * sigma * static_cast<double>(window) * (n - 1) / n;
        const Eigen::Matrix3Xd turned = sums_[counted - 1] - sums_[counted - 1 - window];
        const Eigen::Vector3d mean = turned.rowwise().mean();
        std::vector<Suspect> all;
        for (Eigen::Index m = 0; m < instrument_count(); ++m) {
            const Eigen::Vector3d deviation = turned.col(m) - mean;
            double most = std::sqrt(deviation.squaredNorm() / variance / limits.instrument);
            for (Eigen::Index i = 3 * m; i < 3 * m + 3; ++i) {
                const double along = std::abs(cluster_.axes.row(i).dot(deviation)) / std::sqrt(variance * limits.axis);
                if (!instruments_) all.push_back({along, axis_bit(static_cast<std::size_t>(i))});
                most = std::max(most, along);
            }
            if (instruments_) all.push_back({most, AxisMask{7} << (3 * m)});
        }
        std::partial_sort(all.begin(), all.begin() + 2, all.end(),
                          [](const Suspect& a, const Suspect& b) { return a.certainty > b.certainty; });
        return {.most = all[0], .rival = all[1]};
    }

    geometry::SensorCluster cluster_;
    bool instruments_;
    std::vector<Limits> limits_;
    bool alert_ = false;
    std::vector<Eigen::Matrix3Xd> sums_;
};

/// What has been met, so that the comparison is known to have compared something.
struct Met {
    int isolated = 0;
    int ambiguous = 0;
    int contradicted = 0;

    Met& operator+=(const Met& other)
    {
        isolated += other.isolated;
        ambiguous += other.ambiguous;
        contradicted += other.contradicted;
        return *this;
    }
};

/// Faults of some sigma that come and go on random axes, seldom two at once.
Met compare(std::uint64_t seed, bool instruments)
{
    Random random(seed);
    auto cluster = cluster_named("triads-4");
    cluster.interval_s = interval_s;
    cluster.sigma.setConstant(sigma);
    cluster.quantum.setZero();
    DetectorSettings settings;
    settings.instruments = instruments;
    const auto detector = AccumulatingDetector::make(settings, cluster, MotionNoise{}).value();
    Exhaustive exhaustive(cluster, instruments);
    std::vector<Fault> faults;
    Met met;
    for (std::uint64_t sequence = 0; sequence < 900; ++sequence) {
        if (sequence % 60 == 0) faults.clear();
        if (sequence % 30 == 0 && random.below(2) == 0)
            faults.emplace_back(random.below(12), random.sign() * random.uniform(0.5, 6) * sigma);
        std::vector<double> z = measure(cluster, random.body(1e-3), faults);
        for (double& value : z) value += sigma * random.normal();
        const Judgement expected = exhaustive.add(z);
        Assessment assessment;
        detector->assess({.identity = {.epoch = 1, .sequence = sequence}, .interval_s = interval_s, .increment = z, .valid = cluster.all()},
                         assessment);
        const std::string where = "seed " + std::to_string(seed) + ", frame " + std::to_string(sequence);
        EXPECT_NEAR(assessment.statistic, expected.most.certainty, 1e-9) << where;
        EXPECT_EQ(assessment.outcome == Outcome::isolated, expected.isolated()) << where;
        EXPECT_EQ(assessment.outcome == Outcome::ambiguous, expected.found() && !expected.isolated()) << where;
        if (!expected.found()) continue;
        std::set<AxisMask> candidates{expected.most.axes};
        if (!expected.isolated()) candidates.insert(expected.rival.axes);
        EXPECT_EQ(std::set(assessment.candidate.begin(), assessment.candidate.begin() + assessment.candidate_count), candidates) << where;
        expected.isolated() ? ++met.isolated : ++met.ambiguous;
        met.contradicted += expected.contradicted ? 1 : 0;
        if (::testing::Test::HasFailure()) break;
    }
    return met;
}

TEST(AccumulatingExhaustive, finds_what_all_windows_and_hypotheses_together_find)
{
    for (const bool instruments : {false, true}) {
        Met met;
        for (std::uint64_t seed = 1; seed <= 16 && !HasFailure(); ++seed) met += compare(seed, instruments);
        EXPECT_GT(met.isolated, 1000);
        EXPECT_GT(met.ambiguous, 100);
        EXPECT_GT(met.contradicted, 10);
    }
}

}  // namespace
}  // namespace quorient::fdi
