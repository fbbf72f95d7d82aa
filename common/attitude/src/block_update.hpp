#pragma once

#include "quorient/attitude/update.hpp"

namespace quorient::attitude {

/// `block-N`: every N samples the rotation over those N, from the one polynomial through them, by Picard's iteration. Between
/// its full updates it goes on as window-N does.
class BlockUpdate : public Update {
public:
    explicit BlockUpdate(std::size_t order) : order_(order) {}

    std::size_t memory() const override { return order_; }
    Step step(std::uint64_t count, std::span<const Sample> recent) const override;

private:
    std::size_t order_;
};

}  // namespace quorient::attitude
