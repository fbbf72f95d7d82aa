#include "trust.hpp"
#include "quorient/messages/left_out.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <bit>

namespace quorient::attitude {
namespace {

template <class Function>
void for_each_axis(AxisMask mask, Function function)
{
    for (; mask != 0; mask &= mask - 1) function(static_cast<std::size_t>(std::countr_zero(mask)));
}

/// One walk from the newest opinion to the oldest. An axis goes through runs: excluded by a verdict, confirmed or revised by the following
/// ones, ended by one that clears it. The walk meets a run's newest verdict first, and that one counts.
class Fold {
public:
    explicit Fold(History& history) : history_(history) {}

    // @param index  of the opinion's record; history size = newer than all, before_all = older than all
    void visit(const Opinion& opinion, std::size_t index)
    {
        if (opinion.excluded != 0) visit_exclusions(opinion, index);
        if (!opinion.clears()) return;
        latest_known_ = true;
        open_ &= opinion.excluded;
    }

    void write(Record& record)
    {
        for_each_axis(active_, [&](std::size_t axis) {
            if (from_[axis] > record.last_sequence) active_ &= ~axis_bit(axis);
        });
        record.excluded = active_;
        record.isolated = active_ & isolated_;
    }

    const Exclusions& latest_from() const { return latest_from_; }
    AxisMask latest_isolated() const { return latest_isolated_; }

    static constexpr std::size_t before_all = static_cast<std::size_t>(-1);

private:
    void visit_exclusions(const Opinion& opinion, std::size_t index)
    {
        const AxisMask newest_of_run = opinion.excluded & ~open_;
        for_each_axis(newest_of_run, [&](std::size_t axis) {
            const std::uint64_t from = opinion.excluded_from[axis];
            const bool isolated = has_axis(opinion.isolated, axis);
            if (!latest_known_ && latest_from_[axis] == never) {
                latest_from_[axis] = from;
                if (isolated) latest_isolated_ |= axis_bit(axis);
            }
            latch(axis, from, isolated, index + 1);
            from_[axis] = has_axis(active_, axis) ? std::min(from_[axis], from) : from;
            if (!has_axis(active_, axis)) isolated_ &= ~axis_bit(axis);
            if (isolated) isolated_ |= axis_bit(axis);
        });
        active_ |= newest_of_run;
        open_ |= newest_of_run;
    }

    // Frames after the newest verdict of a run, up to the one that ends it.
    void latch(std::size_t axis, std::uint64_t from, bool isolated, std::size_t begin)
    {
        for (std::size_t i = begin; i < history_.size(); ++i) {
            Record& record = history_[i];
            if (record.own_opinion && record.opinion.clears() && !has_axis(record.opinion.excluded, axis)) return;
            if (record.last_sequence < from) continue;
            record.excluded |= axis_bit(axis);
            if (isolated) record.isolated |= axis_bit(axis);
        }
    }

    History& history_;
    AxisMask active_ = 0;    // excluded at the frame the walk has come to
    AxisMask isolated_ = 0;  // those of them that a run isolates
    AxisMask open_ = 0;      // no clearing verdict since the newest opinion on the run
    bool latest_known_ = false;
    Exclusions from_{};
    Exclusions latest_from_;
    AxisMask latest_isolated_ = 0;
};

}  // namespace

void Trust::keep_early(std::uint64_t epoch, const Opinion& opinion)
{
    if (early_count_ > 0 && epoch < early_epoch_) return;
    if (epoch != early_epoch_) early_count_ = 0;
    early_epoch_ = epoch;
    const auto end = early_.begin() + static_cast<std::ptrdiff_t>(early_count_);
    const auto place =
        std::lower_bound(early_.begin(), end, opinion.sequence, [](const Opinion& o, std::uint64_t s) { return o.sequence < s; });
    if (place != end && place->sequence == opinion.sequence) {
        if (opinion.precedes(*place)) *place = opinion;
        return;
    }
    if (place == early_.end()) return;
    if (early_count_ < early_capacity) ++early_count_;
    std::move_backward(place, early_.begin() + static_cast<std::ptrdiff_t>(early_count_) - 1,
                       early_.begin() + static_cast<std::ptrdiff_t>(early_count_));
    *place = opinion;
}

bool Trust::take_early(std::uint64_t first_sequence, std::uint64_t last_sequence, Opinion& opinion)
{
    if (!has_early()) return false;
    std::size_t passed = 0;
    bool found = false;
    for (; passed < early_count_ && early_[passed].sequence <= last_sequence; ++passed) {
        if (early_[passed].sequence < first_sequence) continue;
        opinion = early_[passed];
        found = true;
    }
    std::move(early_.begin() + static_cast<std::ptrdiff_t>(passed), early_.begin() + static_cast<std::ptrdiff_t>(early_count_),
              early_.begin());
    early_count_ -= passed;
    return found;
}

void Trust::keep_old(const Opinion& opinion)
{
    if (opinion.sequence < old_.sequence) return;
    const Opinion before = old_;
    old_ = opinion;
    if (opinion.clears()) return;
    for_each_axis(before.excluded & ~opinion.excluded, [&](std::size_t axis) { old_.excluded_from[axis] = before.excluded_from[axis]; });
    old_.isolated |= before.isolated & ~opinion.excluded;
    old_.excluded |= before.excluded;
}

void Trust::begin_epoch(std::uint64_t epoch)
{
    epoch_ = epoch;
    if (early_epoch_ != epoch) early_count_ = 0;
    old_ = Opinion{};
    latest_from_ = latest_from_.in_new_epoch();
    old_.excluded_from = latest_from_;
    old_.excluded = latest_from_.mask();
    old_.isolated = latest_isolated_;
    taken_over_.excluded_from = taken_over_.excluded_from.in_new_epoch();
}

void Trust::take_over(const VotedAttitude& voted, History& history)
{
    taken_over_ = opinion_of(voted);
    left_out_by_voters_ = left_out_mask(voted);
    unconfirmed_ = taken_over_.isolated;
    ever_excluded_ = ever_excluded_ || unconfirmed_ != 0;
    for (std::size_t i = 0; i < history.size(); ++i)
        if (history[i].own_opinion) unconfirmed_ &= ~(history[i].opinion.isolated & ~history[i].opinion.taken_over);
    for (std::size_t i = 0; i < history.size(); ++i)
        if (history[i].own_opinion) history[i].opinion.take_over(taken_over_, unconfirmed_);
    for (std::size_t i = 0; i < early_count_; ++i) early_[i].take_over(taken_over_, unconfirmed_);
    keep_old(taken_over_);
    history.know_before(taken_over_.isolated);
}

void Trust::complete(Opinion& opinion)
{
    unconfirmed_ &= ~opinion.isolated;
    opinion.take_over(taken_over_, unconfirmed_);
    ever_excluded_ = ever_excluded_ || opinion.excluded != 0;
}

void Trust::fold(History& history)
{
    Fold walk(history);
    for (std::size_t i = has_early() ? early_count_ : 0; i-- > 0;) walk.visit(early_[i], history.size());
    for (std::size_t i = history.size(); i-- > 0;) {
        if (history[i].own_opinion) walk.visit(history[i].opinion, i);
        walk.write(history[i]);
    }
    walk.visit(old_, Fold::before_all);
    latest_from_ = walk.latest_from();
    latest_isolated_ = walk.latest_isolated();
}

}  // namespace quorient::attitude
