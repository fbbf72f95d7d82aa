#include "quorient/evaluation/run_observer.hpp"

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/restart.hpp"
#include "quorient/messages/words.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <algorithm>

namespace quorient::evaluation {

namespace {

/// Attitudes whose truth never comes (a foreign publisher's) must not pile up.
constexpr std::size_t most_waiting = 4096;

}  // namespace

void Errors::add(Identity identity, double error_rad)
{
    ++compared;
    largest_rad = std::max(largest_rad, error_rad);
    if (identity < final_identity) return;
    final_identity = identity;
    final_rad = error_rad;
}

RunObserver::RunObserver(const system::System& system, Shadow shadow) : system_(system), shadow_wanted_(shadow)
{
    for (const auto& lane : system.lanes) {
        auto& record = lanes_.emplace_back();
        record.name = lane.name;
        record.vendor = lane.detector.process.bus.vendor;
    }
}

LaneRecord* RunObserver::lane_of(std::uint32_t lane)
{
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
        if (system_.lanes[i].integrator.integration.lane == lane) return &lanes_[i];
    }
    return nullptr;
}

LaneRecord* RunObserver::lane_of_detector(std::uint32_t detector)
{
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
        if (system_.lanes[i].detector.detector == detector) return &lanes_[i];
    }
    return nullptr;
}

std::string RunObserver::names_of(AxisMask axes) const
{
    return description_ ? axis_names(*description_, axes) : axis_numbers(axes);
}

double RunObserver::time_s(Identity identity) const
{
    return static_cast<double>(identity.sequence + unit_kind(system_.sensor.kind).frame_end) *
           (description_ ? description_->interval_s : system_.interval_s);
}

void RunObserver::on_description(const ClusterDescription& description)
{
    if (description.unit != system_.unit) return;
    const bool first = !description_;
    description_ = description;
    if (!first || shadow_wanted_ == Shadow::off || system_.lanes.empty() || !description.initial_attitude_known) return;
    auto settings = system_.lanes.front().integrator.integration;
    settings.rollback = false;
    settings.leave_out_suspects = false;
    settings.initial_attitude = description.initial_attitude;
    const auto cluster = geometry::make_cluster(description);
    if (!cluster) return;
    if (auto made = attitude::Integrator::make(settings, *cluster)) shadow_.emplace(std::move(*made));
}

/// Verdicts that wait for their frames: beyond these the frames are taken as lost.
constexpr std::size_t most_early_verdicts = 256;

void RunObserver::on_frame(const SensorFrame& frame)
{
    if (frame.unit != system_.unit || !shadow_ || frame.epoch != description_->epoch) return;
    shadow_->add(frame);
    std::erase_if(early_verdicts_, [&](const FaultVerdict& verdict) {
        const bool due = identity_of(verdict) <= identity_of(frame);
        if (due) shadow_->apply(verdict);
        return due;
    });
    newest_frame_ = identity_of(frame);
    const auto state = shadow_->publish();
    compare(identity_of(state), state.attitude, without_rollback_);
}

void RunObserver::on_truth(const TruthState& truth)
{
    if (truth.unit != system_.unit || truth.epoch < newest_truth_.epoch) return;
    if (truth_frames_ > 0 && truth.epoch != newest_truth_.epoch) return await(truth);
    for (auto& [epoch, later] : later_) later = {{}, true};
    count(truth);
}

/// A restart is counted from its first frame. From a second publisher services take nothing while they wait for the first one.
void RunObserver::await(const TruthState& truth)
{
    auto& later = later_[truth.epoch];
    if (!later.since_present.empty() && truth.sequence <= later.since_present.back().sequence) return;
    later.since_present.push_back(truth);
    const auto frames = truth.sequence - later.since_present.front().sequence + 1;
    if (static_cast<double>(frames) * interval_s() < restart_silence_s(interval_s())) return;
    const LaterEpoch taken = std::move(later);
    later_.erase(later_.begin(), later_.upper_bound(truth.epoch));
    truth_.clear();
    std::erase_if(voted_sequences_, [&](const auto& voted) { return voted.first != truth.epoch; });
    newest_truth_ = {truth.epoch, 0};
    if (taken.overlaps) return count(truth);
    for (const TruthState& each : taken.since_present) count(each);
}

void RunObserver::count(const TruthState& truth)
{
    ++truth_frames_;
    newest_truth_ = identity_of(truth);
    truth_[truth.sequence] = truth;
    if (truth.faulty_mask != 0 && !fault_began_) fault_began_ = newest_truth_;
    if (truth.faulty_mask != 0) fault_ended_.reset();
    else if (fault_began_ && !fault_ended_) fault_ended_ = newest_truth_;
    faulty_ |= truth.faulty_mask;
    faults_.update(truth.faulty_mask, static_cast<double>(truth.sample_time_ns) * 1e-9);
    compare_waiting();
}

void RunObserver::on_verdict(const FaultVerdict& verdict)
{
    auto* lane = verdict.unit == system_.unit ? lane_of_detector(verdict.detector) : nullptr;
    if (!lane) return;
    if (shadow_ && lane == &lanes_.front()) {
        if (identity_of(verdict) <= newest_frame_) shadow_->apply(verdict);
        else early_verdicts_.push_back(verdict);
        if (early_verdicts_.size() > most_early_verdicts) {
            shadow_->apply(early_verdicts_.front());
            early_verdicts_.erase(early_verdicts_.begin());
        }
    }
    lane->verdict = verdict;
    lane->isolated_ever |= verdict.isolated_mask;
    lane->isolated.update(verdict.isolated_mask, static_cast<double>(verdict.sample_time_ns) * 1e-9);
    lane->undecided.add(verdict);
    ++lane->verdicts;
    const auto state = state_of(verdict);
    const bool suspicious = state == VerdictState::suspect || state == VerdictState::ambiguous || state == VerdictState::blind;
    lane->suspicious += suspicious ? 1 : 0;
    if (verdict.isolated_mask == 0 || lane->isolated_at) return;
    lane->isolated_at = identity_of(verdict);
    lane->isolated_first = verdict.isolated_mask;
}

void RunObserver::on_diagnosis(const FaultDiagnosis& diagnosis)
{
    auto* lane = diagnosis.unit == system_.unit ? lane_of_detector(diagnosis.detector) : nullptr;
    if (lane) lane->diagnosis = diagnosis;
}

void RunObserver::on_attitude(const AttitudeState& attitude)
{
    auto* lane = attitude.unit == system_.unit ? lane_of(attitude.lane) : nullptr;
    if (!lane) return;
    lane->attitude = attitude;
    lane->received = true;
    ++lane->frames;
    lane->largest_roll_back = std::max<std::uint64_t>(lane->largest_roll_back, attitude.rolled_back_frames);
    if (attitude.isolated_mask != 0 && lane->triad_after == 0) lane->triad_after = attitude.used_mask;
    compare(identity_of(attitude), attitude.attitude, lane->errors);
}

void RunObserver::on_voted(const VotedAttitude& voted)
{
    if (voted.unit != system_.unit) return;
    auto& last = output_sequences_[voted.voter];
    if (last != 0 && voted.output_sequence <= last) ++voted_.disordered;
    last = voted.output_sequence;
    if (!voted_.received || identity_of(voted) >= identity_of(voted_.latest)) voted_.latest = voted;
    voted_.received = true;
    const bool held = level_of(voted) == VoteLevel::coasting || level_of(voted) == VoteLevel::lost;
    if (held) return;
    voted_.frame_level = level_of(voted);
    if (voted.epoch >= newest_truth_.epoch && voted_sequences_[voted.epoch].insert(voted.sequence).second) ++voted_.frames;
    compare(identity_of(voted), voted.attitude, voted_.errors);
}

VoteLevel RunObserver::final_level() const
{
    return source_ended_ ? voted_.frame_level : level_of(voted_.latest);
}

std::uint64_t RunObserver::missing_voted() const
{
    const auto voted = voted_sequences_.find(newest_truth_.epoch);
    if (voted == voted_sequences_.end()) return truth_.size();
    return static_cast<std::uint64_t>(
        std::count_if(truth_.begin(), truth_.end(), [&](const auto& entry) { return !voted->second.contains(entry.first); }));
}

std::optional<std::uint64_t> RunObserver::frames_to_isolation(const LaneRecord& lane) const
{
    if (!lane.isolated_at || !fault_began_ || lane.isolated_at->epoch != fault_began_->epoch || *lane.isolated_at < *fault_began_)
        return std::nullopt;
    return lane.isolated_at->sequence - fault_began_->sequence + 1;
}

void RunObserver::compare(Identity identity, const std::array<double, 4>& attitude, Errors& errors)
{
    const auto truth = identity.epoch == newest_truth_.epoch ? truth_.find(identity.sequence) : truth_.end();
    if (truth == truth_.end()) {
        if (waiting_.size() < most_waiting) waiting_.push_back({identity, attitude, &errors});
        return;
    }
    if (!truth->second.attitude_known) return;
    const double error_rad = rotation::angle_between(attitude, truth->second.attitude);
    errors.add(identity, error_rad);
    if (watch_ && (&errors == &voted_.errors || &errors == &without_rollback_)) watch_(errors, truth->second, error_rad);
}

void RunObserver::compare_waiting()
{
    auto waiting = std::move(waiting_);
    waiting_.clear();
    for (const auto& entry : waiting) {
        // Older than the newest truth and still without its own: that truth was never sent.
        if (entry.identity >= newest_truth_ || truth_.contains(entry.identity.sequence))
            compare(entry.identity, entry.attitude, *entry.errors);
    }
}

}  // namespace quorient::evaluation
