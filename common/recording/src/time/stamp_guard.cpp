#include "stamp_guard.hpp"

#include "quorient/messages/time.hpp"
#include "stamps.hpp"


namespace quorient::recording {
namespace {

constexpr std::int64_t believed_after_ns = 3'000'000'000;
constexpr std::int64_t set_back_ns = 250'000'000;  // less is a sample out of order
constexpr double longest_regular_step = 3.0;       // periods
constexpr std::size_t most_doubted = 100'000;

}  // namespace

void StampGuard::add(const InstrumentSample& sample, std::vector<InstrumentSample>& good)
{
    if (!last_ns_) {
        accept(sample, good);
        return;
    }
    const std::int64_t step_ns = sample.time_ns + shift_ns_ - *last_ns_;
    const std::int64_t doubted_ns = doubted_.empty() ? 0 : doubted_.back().time_ns - doubted_.front().time_ns;
    if (step_ns == 0) {
        ++dropped_;
    } else if (step_ns > 0 && step_ns <= longest_step_ns + doubted_ns && !continues_set_back_line(sample)) {
        dropped_ += doubted_.size();
        doubted_.clear();
        accept(sample, good);
    } else {
        doubt(sample);
        if (doubted_.back().time_ns - doubted_.front().time_ns >= believed_after_ns || doubted_.size() > most_doubted) believe(good);
    }
}

bool StampGuard::continues_set_back_line(const InstrumentSample& sample) const
{
    if (doubted_.empty() || *last_ns_ - (doubted_.front().time_ns + shift_ns_) < set_back_ns) return false;
    const double step_s = static_cast<double>(sample.time_ns - doubted_.back().time_ns) * 1e-9;
    return step_s > 0 && step_s < longest_regular_step * period_s_;
}

/// Keeps a sample that may begin or continue another line.
void StampGuard::doubt(const InstrumentSample& sample)
{
    const std::int64_t step_ns = doubted_.empty() ? 0 : sample.time_ns - doubted_.back().time_ns;
    if (!doubted_.empty() && (step_ns <= 0 || step_ns > longest_step_ns)) {
        dropped_ += doubted_.size();
        doubted_.clear();
    }
    doubted_.push_back(sample);
}

void StampGuard::believe(std::vector<InstrumentSample>& good)
{
    const std::int64_t step_ns = doubted_.front().time_ns + shift_ns_ - *last_ns_;
    if (step_ns <= 0) shift_ns_ += nanoseconds(period_s_) - step_ns;
    for (const InstrumentSample& sample : doubted_) accept(sample, good);
    doubted_.clear();
}

void StampGuard::accept(const InstrumentSample& sample, std::vector<InstrumentSample>& good)
{
    good.push_back(sample);
    good.back().time_ns += shift_ns_;
    last_ns_ = good.back().time_ns;
}

void StampGuard::finish(std::vector<InstrumentSample>& good)
{
    if (doubted_.empty()) return;
    if (doubted_.front().time_ns + shift_ns_ > *last_ns_) believe(good);
    dropped_ += doubted_.size();
    doubted_.clear();
}

}  // namespace quorient::recording
