#include "watch.hpp"

#include <algorithm>

namespace quorient::diagnosis {
namespace {

constexpr std::size_t remembered = 8192;  // frames: longer than any window of a detector
constexpr double snapshot_s = 0.5;

/// The detector compares from its second second on.
constexpr double detector_begins_s = 1.2;

/// Spells that are no further apart are one.
constexpr double joined_s = 0.5;
constexpr std::size_t most_noted_spells = 10'000;

}  // namespace

Watch::Watch(const geometry::SensorCluster& cluster, std::unique_ptr<fdi::Detector> detector, AxisMask left_out)
    : cluster_(cluster), detector_(std::move(detector)), named_(left_out), begins_s_(remembered)
{
    if (left_out != 0) detector_->exclude(left_out);
}

double Watch::begin_of(std::uint64_t sequence) const
{
    const std::uint64_t oldest = newest_ >= remembered ? newest_ - remembered + 1 : 0;
    return begins_s_[std::max(sequence, oldest) % remembered];
}

void Watch::add(const fdi::Measurement& measurement, double begin_s, double end_s)
{
    newest_ = measurement.identity.sequence;
    last_s_ = end_s;
    if (!first_s_) first_s_ = begin_s;
    begins_s_[newest_ % remembered] = begin_s;
    detector_->assess(measurement, assessment_);
    if (assessment_.provisional != 0) note_spell(Spell::What::contradicted, assessment_.provisional, assessment_.provisional_from, begin_s, end_s);
    if (assessment_.saturated) note_spell(Spell::What::saturated, cluster_.all(), newest_, begin_s, end_s);
    if (assessment_.outcome == fdi::Outcome::ambiguous) {
        AxisMask axes = 0;
        for (std::size_t i = 0; i < assessment_.candidate_count; ++i) axes |= assessment_.candidate[i];
        note_spell(Spell::What::disagreement, axes, assessment_.onset, begin_s, end_s);
    }
    const auto over = [&](const Spell& spell) { return spell.to_s < end_s - joined_s; };
    for (const Spell& spell : open_)
        if (over(spell) && spells_.size() < most_noted_spells) spells_.push_back(spell);
    open_.erase(std::remove_if(open_.begin(), open_.end(), over), open_.end());
    note_isolations(end_s);
}

void Watch::finish()
{
    spells_.insert(spells_.end(), open_.begin(), open_.end());
    open_.clear();
    for (Isolation& isolation : isolations_) isolation.newest = snapshot_of(isolation.instrument, last_s_);
}

void Watch::replace_all_but(AxisMask kept, const Watch& other)
{
    const auto goes = [&](const Isolation& isolation) { return !has_axis(kept, 3 * isolation.instrument); };
    isolations_.erase(std::remove_if(isolations_.begin(), isolations_.end(), goes), isolations_.end());
    isolations_.insert(isolations_.end(), other.isolations_.begin(), other.isolations_.end());
    spells_ = other.spells_;
}

Snapshot Watch::snapshot_of(std::size_t instrument, double time_s) const
{
    Snapshot snapshot{time_s, {}};
    for (std::size_t i = 0; i < 3; ++i) snapshot.axis[i] = assessment_.diagnosis[3 * instrument + i];
    return snapshot;
}

void Watch::note_spell(Spell::What what, AxisMask axes, std::uint64_t onset, double begin_s, double end_s)
{
    auto spell = std::find_if(open_.begin(), open_.end(), [&](const Spell& s) { return s.what == what && s.axes == axes; });
    if (spell == open_.end()) {
        const double from_s = onset == never ? begin_s : std::min(begin_s, begin_of(onset));
        spell = open_.insert(open_.end(), Spell{what, axes, from_s, end_s, 0, {}});
    }
    spell->to_s = end_s;
    spell->certainty = std::max(spell->certainty, assessment_.statistic);
    spell->diagnosis = assessment_.diagnosis;
}

/// What was there when the detector began to compare was there from the first sample on.
double Watch::fault_begin(double time_s) const
{
    const double begin_s = assessment_.onset == never ? time_s : begin_of(assessment_.onset);
    return begin_s < *first_s_ + detector_begins_s ? *first_s_ : begin_s;
}

void Watch::note_isolations(double time_s)
{
    const AxisMask fresh = assessment_.outcome == fdi::Outcome::isolated ? assessment_.isolated & ~named_ : 0;
    for (std::size_t m = 0; fresh != 0 && m < cluster_.instrument_name.size(); ++m) {
        if ((cluster_.axes_of(m) & fresh) == 0) continue;
        named_ |= cluster_.axes_of(m);
        isolations_.push_back({m, fault_begin(time_s), time_s, Decimated<Snapshot>(2000), {}});
    }
    if (fresh != 0) detector_->exclude(named_);
    if (time_s - last_snapshot_s_ < snapshot_s) return;
    last_snapshot_s_ = time_s;
    for (Isolation& isolation : isolations_) isolation.snapshots.add(snapshot_of(isolation.instrument, time_s));
}

}  // namespace quorient::diagnosis
