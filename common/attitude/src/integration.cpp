#include "integration.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace quorient::attitude {
namespace {

// While nothing is known of the rotation it is taken to go on as before, and never to be slower than this.
constexpr double slowest_coasting_rad_s = 0.01;

}  // namespace

void Integration::step(History& history)
{
    const std::size_t index = cursor_++;
    Record& record = history[index];
    Standing now = history.standing_before(index);
    const Quaternion held = now.attitude;
    now.count = count_after(now, record);
    grow(now, record);

    if (now.count == 0) {
        window_.clear();
    } else {
        const auto look_back = static_cast<std::size_t>(std::min<std::uint64_t>(now.count, update_->memory())) - 1;
        const Step step = update_->step(now.count, window_.advance(history, index, look_back));
        assert(step.span <= index + 1);
        now.attitude = renormalised(history.standing_before(index + 1 - step.span).attitude * step.rotation);
        if (record.bridge) {
            // The coning inside a gap is at best a guess from its neighbours, and over a long gap none: it counts as uncertainty.
            const double guess = angle_between(held * from_rotation_vector(record.body), now.attitude);
            now.systematic_rad += std::max(guess, record.body.squaredNorm() / 12);
        }
    }
    record.standing = now;
}

std::uint64_t Integration::count_after(const Standing& before, const Record& record) const
{
    if (record.judgement.used == 0) return 0;
    return before.count > 0 && same_start(before.interval_s, record.interval_s) ? before.count + 1 : 1;
}

// All of a standing but its attitude and count.
void Integration::grow(Standing& standing, const Record& record) const
{
    standing.interval_s = record.interval_s;
    if (record.judgement.saturated) standing.alignment = std::max(standing.alignment, Alignment::untrusted);
    if (record.judgement.used == 0) {
        standing.coasting_s += record.interval_s;
        if (standing.coasting_s > lost_after_s_) standing.alignment = Alignment::lost;
        standing.systematic_rad += std::max(standing.rate_rad_s, slowest_coasting_rad_s) * record.interval_s;
        return;
    }
    standing.coasting_s = 0;
    standing.rate_rad_s = record.body.norm() / record.interval_s;
    standing.variance += record.variance * record.interval_s / nominal_interval_s_;
    standing.systematic_rad += record.judgement.doubt_rad;
}

Standing Integration::follow(Standing standing, const Record& record) const
{
    if (record.judgement.used != 0) standing.attitude = renormalised(standing.attitude * from_rotation_vector(record.body));
    grow(standing, record);
    return standing;
}

void Integration::catch_up(History& history)
{
    for (std::size_t done = 0; done < slice && !has_caught_up(history); ++done) {
        step(history);
        ++integrated_again_;
    }
}

std::size_t Integration::first_restorable(const History& history, std::size_t index) const
{
    while (index < history.size() && index + 1 < std::min<std::uint64_t>(history[index].standing.count, update_->memory())) ++index;
    return index;
}

void Integration::go_back_to(const History& history, std::size_t index)
{
    index = first_restorable(history, index);
    if (index >= cursor_) return;
    cursor_ = index;
    window_.clear();
}

void Integration::restart()
{
    cursor_ = 0;
    integrated_again_ = 0;
    window_.clear();
}

const char* Integration::broken_invariant(const History& history) const
{
    if (cursor_ > history.size()) return "the cursor is behind the newest record";
    if (!window_.agrees_with(history, cursor_)) return "the window holds other samples than the history";
    for (std::size_t i = 0; i < cursor_; ++i) {
        const Standing& before = history.standing_before(i);
        const Standing& standing = history[i].standing;
        if (standing.count > 1 && standing.count != before.count + 1) return "a record counts samples that its predecessor does not have";
        if (standing.alignment < before.alignment) return "an attitude became trustworthy without being aligned";
        if (standing.systematic_rad < before.systematic_rad || standing.variance < before.variance) return "an uncertainty shrank";
    }
    return nullptr;
}

}  // namespace quorient::attitude
