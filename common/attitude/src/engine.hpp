#pragma once

#include "history.hpp"
#include "quorient/attitude/integrator.hpp"
#include "quorient/messages/identity.hpp"
#include "trust.hpp"

namespace quorient::attitude {

/// What Integrator promises, on one history. Records before `cursor_` are integrated with the axes now trusted; what lies
/// behind it waits for work(). The public standing follows the old track until the cursor has caught up.
class Integrator::Engine {
public:
    Engine(const IntegratorSettings& settings, std::unique_ptr<const Update> update, const geometry::SensorCluster& cluster,
           std::size_t capacity);

    void add(const SensorFrame& frame);
    void apply(const FaultVerdict& verdict);
    bool work();
    AttitudeState state() const;
    void mark_published();
    std::uint64_t history_too_short() const { return history_too_short_; }
    void seed(const VotedAttitude& voted);
    AxisMask distrusted_in_seed() const;
    void let_go(AxisMask axes) { unconfirmed_ &= ~axes; }
    bool reset(const Quaternion& attitude, std::uint64_t sequence);
    void begin_epoch(std::uint64_t epoch, const Quaternion& attitude);

private:
    static constexpr std::size_t slice = 128;

    // Records, seeds and starts (engine_input.cpp).
    void enter_epoch(std::uint64_t epoch);
    void append_gap(const SensorFrame& frame, std::uint64_t lost);
    void append_frame(const SensorFrame& frame);
    Record& append_record();
    void integrate_appended();
    void drop_oldest();
    void close_history(std::size_t count, const Standing& standing);
    void connect_seed();

    // Trust.
    void take_over(const VotedAttitude& voted);
    void confirm(Opinion& opinion);
    bool hear(const Opinion& opinion, std::size_t index);
    std::size_t carry_opinion(std::size_t index);
    void refold();
    std::size_t refresh(std::size_t begin, std::size_t end);
    void judge_record(Record& record);
    std::size_t first_restorable(std::size_t index) const;
    void go_back_to(std::size_t index);

    // Integration.
    bool caught_up() const { return cursor_ == history_.size(); }
    void integrate(std::size_t index);
    void grow(Standing& standing, const Record& record) const;
    void gather_window(std::size_t index, std::size_t held);
    void follow_old_track(const Record& record);
    void finish_correction();
    const Standing& before(std::size_t index) const { return index == 0 ? anchor_ : history_[index - 1].standing; }
    const Quaternion& attitude_back(std::size_t index, std::size_t span) const;

    IntegratorSettings settings_;
    std::unique_ptr<const Update> update_;
    BodyIncrement body_;
    std::size_t axis_count_;
    double nominal_interval_s_;

    History history_;
    Trust trust_;
    Standing anchor_;              // before the oldest record
    Opinion carried_;              // in force before the oldest record
    Standing public_;              // at the newest record, as announced
    Quaternion announced_;         // of the newest frame published, as it was published
    std::size_t unpublished_ = 0;  // records newer than that
    std::size_t cursor_ = 0;
    std::array<Sample, longest_memory> window_{};  // up to the record before window_end_
    std::size_t window_size_ = 0;
    std::size_t window_end_ = 0;

    std::uint64_t epoch_ = 0;
    bool epoch_known_ = false;
    std::uint64_t next_sequence_ = 0;
    std::int64_t sample_time_ns_ = 0;
    bool bridged_ = false;
    std::array<double, max_axes> accumulated_{};  // of the frame before next_sequence_
    std::array<std::uint32_t, max_axes> missed_{};
    bool accumulated_known_ = true;

    Identity verdict_applied_{};
    bool history_dropped_ = false;   // frames have left the history since it began
    bool exclusions_known_ = false;  // false: no verdict has excluded anything yet
    std::uint64_t history_too_short_ = 0;

    bool initialised_ = true;
    bool catching_up_ = false;  // seeded, not yet integrated to the newest frame
    bool seeded_ = false;
    bool seed_waits_ = false;
    VotedAttitude waiting_seed_;
    Identity seed_frame_;
    Opinion taken_over_;        // the exclusions of the newest seed
    AxisMask unconfirmed_ = 0;  // those that the lane's own detector has never had
    bool start_known_ = false;  // begin_epoch() was called for start_epoch_
    std::uint64_t start_epoch_ = 0;
    Quaternion start_attitude_ = Quaternion::Identity();

    std::uint32_t reset_counter_ = 0;
    Quaternion reset_rotation_ = Quaternion::Identity();
    std::uint32_t rolled_back_frames_ = 0;
    std::size_t integrated_again_ = 0;  // since the pending roll-back began
};

}  // namespace quorient::attitude
