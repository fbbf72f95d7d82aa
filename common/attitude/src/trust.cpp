#include "trust.hpp"
#include "quorient/messages/exclusions.hpp"

#include <algorithm>
#include <bit>

namespace quorient::attitude {
namespace {

template <class Function>
void for_each_axis(AxisMask mask, Function function)
{
    for (; mask != 0; mask &= mask - 1) function(static_cast<std::size_t>(std::countr_zero(mask)));
}

// One walk from the newest opinion to the oldest.
class Fold {
public:
    explicit Fold(History& history) : history_(history) {}

    // @param index  of the opinion's record; history size = newer than all, npos = older than all
    void hear(const Opinion& opinion, std::size_t index)
    {
        if (opinion.excluded != 0) hear_exclusions(opinion, index);
        if (!opinion.clears()) return;
        latest_known_ = true;
        open_ &= opinion.excluded;
    }

    AxisMask excluded_in(const Record& record)
    {
        for_each_axis(active_, [&](std::size_t axis) {
            if (from_[axis] > record.last_sequence) active_ &= ~axis_bit(axis);
        });
        return active_;
    }

    const Exclusions& latest_from() const { return latest_from_; }

    static constexpr std::size_t before_all = static_cast<std::size_t>(-1);

private:
    void hear_exclusions(const Opinion& opinion, std::size_t index)
    {
        // Axes of an open run have a newer opinion, which counts.
        const AxisMask heard = opinion.excluded & ~open_;
        for_each_axis(heard, [&](std::size_t axis) {
            const std::uint64_t from = opinion.excluded_from[axis];
            if (!latest_known_ && latest_from_[axis] == never) latest_from_[axis] = from;
            if (has_axis(active_, axis)) {
                from_[axis] = std::min(from_[axis], from);
            } else {
                from_[axis] = from;
                latch(axis, from, index + 1);
            }
        });
        active_ |= heard;
        open_ |= heard;
    }

    // Frames after the last verdict of a run, up to the one that clears it.
    void latch(std::size_t axis, std::uint64_t from, std::size_t begin)
    {
        for (std::size_t i = begin; i < history_.size(); ++i) {
            Record& record = history_[i];
            if (record.own_opinion && record.opinion.clears() && !has_axis(record.opinion.excluded, axis)) return;
            if (record.last_sequence >= from) record.excluded |= axis_bit(axis);
        }
    }

    History& history_;
    AxisMask active_ = 0;  // excluded at the frame the walk has come to
    AxisMask open_ = 0;    // no clearing verdict since the newest opinion on the run
    bool latest_known_ = false;
    Exclusions from_{};
    Exclusions latest_from_;
};

}  // namespace

void Trust::hear_early(std::uint64_t epoch, const Opinion& opinion)
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
    if (!waiting()) return false;
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

void Trust::hear_old(const Opinion& opinion)
{
    if (opinion.sequence < old_.sequence) return;
    const Opinion before = old_;
    old_ = opinion;
    if (opinion.clears()) return;
    for_each_axis(before.excluded & ~opinion.excluded, [&](std::size_t axis) { old_.excluded_from[axis] = before.excluded_from[axis]; });
    old_.excluded |= before.excluded;
}

void Trust::take_over(const Opinion& other, AxisMask axes)
{
    for (std::size_t i = 0; i < early_count_; ++i) early_[i].take_over(other, axes);
}

void Trust::begin_epoch(std::uint64_t epoch)
{
    epoch_ = epoch;
    if (early_epoch_ != epoch) early_count_ = 0;
    old_ = Opinion{};
    latest_from_ = latest_from_.in_new_epoch();
    old_.excluded_from = latest_from_;
    old_.excluded = latest_from_.mask();
}

void Trust::fold(History& history)
{
    Fold walk(history);
    for (std::size_t i = waiting() ? early_count_ : 0; i-- > 0;) walk.hear(early_[i], history.size());
    for (std::size_t i = history.size(); i-- > 0;) {
        if (history[i].own_opinion) walk.hear(history[i].opinion, i);
        history[i].excluded = walk.excluded_in(history[i]);
    }
    walk.hear(old_, Fold::before_all);
    latest_from_ = walk.latest_from();
}

AxisMask Trust::excluded_at(std::uint64_t sequence) const
{
    return latest_from_.mask_at(sequence);
}

}  // namespace quorient::attitude
