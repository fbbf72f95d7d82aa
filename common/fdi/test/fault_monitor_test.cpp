#include "quorient/fdi/fault_monitor.hpp"

#include "quorient/fdi/methods.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace quorient::fdi {
namespace {

constexpr double interval_s = 0.01;
constexpr double sigma_rad = 1e-5;

geometry::SensorCluster cone_6()
{
    auto cluster = geometry::layout("cone-6").value();
    cluster.sigma.setConstant(sigma_rad);
    cluster.interval_s = interval_s;
    return cluster;
}

/// Assesses as the test says, and remembers what was excluded.
class ScriptedDetector : public Detector {
public:
    void assess(const Measurement&, Assessment& assessment) override { assessment = next; }
    void exclude(AxisMask axes) override
    {
        excluded = axes;
        ++exclusions;
    }
    unsigned detectable_remaining() const override { return excluded == 0 ? 2 : 1; }
    void reset() override { ++resets; }

    Assessment next{.outcome = Outcome::healthy};
    AxisMask excluded = 0;
    int exclusions = 0;
    int resets = 0;
};

class FaultMonitorTest : public ::testing::Test {
protected:
    FaultMonitorTest() { make({}); }

    void make(const VerdictSettings& settings)
    {
        auto detector = std::make_unique<ScriptedDetector>();
        detector_ = detector.get();
        monitor_.emplace(FaultMonitor::make(std::move(detector), settings, cone_6()).value());
        next_ = 0;
        feed(20);
    }

    /// Frames of a body that turns at `rate`; axis 1 measures `factor` of the truth.
    const FaultVerdict& feed(unsigned frames, const Eigen::Vector3d& rate_rad_s = {0.1, 0.2, 0.3}, double factor = 1)
    {
        const FaultVerdict* verdict = nullptr;
        for (unsigned i = 0; i < frames; ++i) {
            SensorFrame frame;
            frame.epoch = epoch_;
            frame.sequence = next_++;
            frame.interval_s = interval_s;
            frame.axis_count = 6;
            frame.valid_mask = 0b111111;
            frame.unit = 9;
            frame.kind = octet(SensorKind::gyro);
            const geometry::AxisVector z = cone_6().axes * rate_rad_s * interval_s;
            for (std::size_t axis = 0; axis < 6; ++axis)
                frame.increment[axis] = z(static_cast<Eigen::Index>(axis)) * (axis == 1 ? factor : 1) + noise_(random_);
            verdict = &monitor_->assess(frame);
        }
        return *verdict;
    }

    void isolate_axis_1(const Eigen::Vector3d& rate_rad_s = {0.1, 0.2, 0.3})
    {
        detector_->next = {.outcome = Outcome::isolated, .isolated = 0b10};
        feed(2, rate_rad_s, 0.8);
        detector_->next = {.outcome = Outcome::healthy};
    }

    ScriptedDetector* detector_ = nullptr;
    std::optional<FaultMonitor> monitor_;
    std::uint64_t epoch_ = 1;
    std::uint64_t next_ = 0;
    std::mt19937_64 random_{4};
    std::normal_distribution<double> noise_{0, sigma_rad};
};

TEST_F(FaultMonitorTest, tells_the_detector_what_to_leave_out_when_the_latched_set_changes_and_only_then)
{
    EXPECT_EQ(detector_->exclusions, 0);
    isolate_axis_1();
    EXPECT_EQ(detector_->excluded, 0b10U);
    EXPECT_EQ(detector_->exclusions, 1);
    const FaultVerdict& verdict = feed(10);
    EXPECT_EQ(detector_->exclusions, 1);
    EXPECT_EQ(verdict.detectable_remaining, 1);
    EXPECT_EQ(verdict.unit, 9U);
    EXPECT_EQ(verdict.isolated_mask, 0b10U);
}

TEST_F(FaultMonitorTest, resets_the_detector_with_a_new_epoch_and_keeps_its_exclusions)
{
    isolate_axis_1();
    epoch_ = 2;
    next_ = 0;
    const FaultVerdict& verdict = feed(1);
    EXPECT_EQ(detector_->resets, 1);
    EXPECT_EQ(detector_->excluded, 0b10U);
    EXPECT_EQ(verdict.excluded_from[1], 0U);
}

TEST_F(FaultMonitorTest, answers_an_old_frame_with_the_verdict_it_already_gave)
{
    isolate_axis_1();
    const FaultVerdict before = feed(5);
    next_ -= 3;
    detector_->next = {.outcome = Outcome::isolated, .isolated = 0b100};
    const FaultVerdict& after = feed(1);
    EXPECT_EQ(after.sequence, before.sequence);
    EXPECT_EQ(after.isolated_mask, before.isolated_mask);
}

TEST_F(FaultMonitorTest, adopts_and_readmits_by_command)
{
    auto excluded_from = Exclusions{};
    excluded_from[3] = 12;
    monitor_->adopt(excluded_from);
    EXPECT_EQ(detector_->excluded, 0b1000U);
    EXPECT_EQ(feed(1).excluded_from[3], 12U);
    EXPECT_FALSE(monitor_->readmit(0b10));
    EXPECT_TRUE(monitor_->readmit(0b1000));
    EXPECT_EQ(detector_->excluded, 0U);
    EXPECT_EQ(feed(1).isolated_mask, 0U);
}

TEST_F(FaultMonitorTest, does_not_readmit_by_itself_unless_configured)
{
    isolate_axis_1();
    EXPECT_EQ(feed(2000).isolated_mask, 0b10U);
}

TEST_F(FaultMonitorTest, readmits_after_a_healthy_time_under_the_excitation_that_exposed_the_fault)
{
    make({.readmit_after_s = 1.0});
    isolate_axis_1();
    EXPECT_EQ(feed(90, {0.11, 0.22, 0.33}).isolated_mask, 0b10U) << "0.9 s are not 1 s";
    const FaultVerdict& verdict = feed(15, {0.11, 0.22, 0.33});
    EXPECT_EQ(verdict.isolated_mask, 0U);
    EXPECT_EQ(verdict.state, octet(VerdictState::healthy));
    EXPECT_EQ(detector_->excluded, 0U);
}

TEST_F(FaultMonitorTest, does_not_readmit_a_soft_axis_that_rests)
{
    make({.readmit_after_s = 1.0});
    isolate_axis_1();
    EXPECT_EQ(feed(3000, {0.0, 0.0, 0.0}, 0.8).isolated_mask, 0b10U) << "at rest it looks healthy";
    EXPECT_EQ(feed(3000, {0.05, 0.1, 0.15}).isolated_mask, 0b10U) << "half the excitation proves nothing";
}

TEST_F(FaultMonitorTest, does_not_readmit_an_axis_that_is_still_soft)
{
    make({.readmit_after_s = 1.0});
    isolate_axis_1();
    EXPECT_EQ(feed(3000, {0.2, 0.4, 0.6}, 0.8).isolated_mask, 0b10U);
    EXPECT_EQ(feed(3000, {0.2, 0.4, 0.6}, 0.999).isolated_mask, 0b10U) << "too soft for one frame's noise, not for the sum";
}

TEST_F(FaultMonitorTest, never_readmits_by_itself_what_it_adopted)
{
    make({.readmit_after_s = 1.0});
    auto excluded_from = Exclusions{};
    excluded_from[1] = 12;
    monitor_->adopt(excluded_from);
    EXPECT_EQ(feed(3000).isolated_mask, 0b10U);
}

TEST(FaultMonitor, says_why_a_method_or_a_setting_cannot_serve)
{
    const auto unknown = FaultMonitor::make({.method = "gtl"}, {}, cone_6());
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error(), ::testing::HasSubstr("gtl"));
    const auto settings = FaultMonitor::make({.method = "glt"}, {.confirm_required = 9}, cone_6());
    ASSERT_FALSE(settings);
    EXPECT_THAT(settings.error(), ::testing::HasSubstr("confirm_required"));
}

}  // namespace
}  // namespace quorient::fdi
