#include "levels.hpp"

#include <algorithm>
#include <bit>

namespace quorient::voting {

void Levels::publish(LaneMask vouching)
{
    frames_ = std::min(frames_ + 1, window_ + 1);
    for (std::size_t lane = 0; lane < lanes_; ++lane) votes_[lane] = votes_[lane] << 1 | (vouching >> lane & 1U);
    count_standing();
}

void Levels::late_vote(std::size_t lane, std::uint64_t age)
{
    if (age >= frames_) return;
    votes_[lane] |= std::uint64_t{1} << age;
    count_standing();
}

void Levels::clear()
{
    votes_.fill(0);
    frames_ = 0;
    standing_ = 0;
}

VoteLevel Levels::level(LaneMask excluded, bool redundancy_left) const
{
    const auto standing = static_cast<std::size_t>(std::popcount(standing_ & ~excluded));
    if (standing <= 1) return VoteLevel::single;
    return standing == lanes_ && redundancy_left ? VoteLevel::full : VoteLevel::degraded;
}

void Levels::count_standing()
{
    const bool first = frames_ <= 1;
    const unsigned counted = first ? frames_ : frames_ - 1;
    const std::uint64_t mask = ((std::uint64_t{1} << counted) - 1) << (first ? 0 : 1);
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const auto votes = static_cast<unsigned>(std::popcount(votes_[lane] & mask));
        const LaneMask bit = LaneMask{1} << lane;
        if (votes * 10 >= counted * 8) standing_ |= bit;
        if (votes * 2 <= counted) standing_ &= ~bit;
    }
}

}  // namespace quorient::voting
