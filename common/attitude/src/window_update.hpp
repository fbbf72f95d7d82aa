#pragma once

#include "quorient/attitude/update.hpp"

namespace quorient::attitude {

/// What a stretch of neighbouring samples says about the body rate, to the order that they support.
///
/// The order (number of samples fitted) is that of the stretch, but
///  - 3 where second differences of the rate outweigh first differences: a sinusoid above a sixth of the sampling rate, or
///    noise. More samples then say less (measured: README, "Beyond the window").
///  - limited by (target's interval / shortest interval fitted)^(order - 1) <= 100, which bounds how much a fit amplifies the
///    noise of short samples in a long one.
class Stretch {
public:
    explicit Stretch(std::span<const Sample> samples);

    /// The rotation over one of the samples, with up to `order` of them fitted around it, the newer ones last.
    Quaternion rotation(std::size_t target) const;

private:
    std::size_t order_at(std::size_t target) const;
    std::size_t begin_at(std::size_t target, std::size_t order) const;

    std::span<const Sample> samples_;
    bool equal_ = true;
    std::size_t order_ = 0;
};

/// `window-N`: at every sample the rotation over that sample alone, from the polynomial through the newest N, by Picard's
/// iteration. While fewer than N are there, the whole start is fitted and integrated again at every sample.
class WindowUpdate : public Update {
public:
    explicit WindowUpdate(std::size_t order) : order_(order) {}

    std::size_t memory() const override { return order_; }
    Step step(std::uint64_t count, std::span<const Sample> recent) const override;

private:
    std::size_t order_;
};

}  // namespace quorient::attitude
