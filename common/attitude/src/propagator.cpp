#include "quorient/attitude/propagator.hpp"

#include <algorithm>

namespace quorient::attitude {

Propagator::Propagator(std::unique_ptr<const Update> update, const Quaternion& initial) : update_(std::move(update))
{
    attitudes_.fill(Quaternion::Identity());
    attitudes_[0] = initial;
}

const Quaternion& Propagator::add(const Sample& sample)
{
    if (held_ > 0 && !same_start(recent_[held_ - 1].interval_s, sample.interval_s)) held_ = count_ = 0;
    if (held_ == update_->memory()) {
        std::move(recent_.begin() + 1, recent_.begin() + static_cast<std::ptrdiff_t>(held_), recent_.begin());
        --held_;
    }
    recent_[held_++] = sample;
    ++count_;
    ++total_;

    const Step step = update_->step(count_, std::span(recent_).first(held_));
    const Quaternion& base = attitudes_[(total_ - step.span) % attitudes_.size()];
    attitudes_[total_ % attitudes_.size()] = renormalised(base * step.rotation);
    return attitude();
}

}  // namespace quorient::attitude
