#pragma once

#include "quorient/attitude/update.hpp"

#include <array>

namespace quorient::attitude {

/// An update algorithm fed sample by sample: body increments in, the attitude at the end of every sample out. No allocation.
class Propagator {
public:
    Propagator(std::unique_ptr<const Update> update, const Quaternion& initial);

    const Quaternion& add(const Sample& sample);

    const Quaternion& attitude() const { return attitudes_[total_ % attitudes_.size()]; }

private:
    std::unique_ptr<const Update> update_;
    std::array<Sample, longest_memory> recent_{};
    std::array<Quaternion, longest_memory + 1> attitudes_;  // by number of samples, modulo its size
    std::size_t held_ = 0;
    std::uint64_t count_ = 0;  // since the start
    std::uint64_t total_ = 0;
};

}  // namespace quorient::attitude
