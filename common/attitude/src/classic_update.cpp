#include "classic_update.hpp"

#include <algorithm>
#include <cassert>

namespace quorient::attitude {
namespace {

using Vector = Eigen::Vector3d;

// Linear rate through two samples: 1/12 th_previous x th where their intervals are equal.
Vector with_previous(const Sample& previous, const Sample& sample)
{
    const double h = sample.interval_s;
    const double before = previous.interval_s;
    return sample.increment + h * h / (6 * before * (before + h)) * previous.increment.cross(sample.increment);
}

Vector two(const Vector& a, const Vector& b)
{
    return a + b + 2.0 / 3 * a.cross(b);
}

Vector three(const Vector& a, const Vector& b, const Vector& c)
{
    return a + b + c + (9.0 / 20 * a + 27.0 / 20 * b).cross(c);
}

Vector three_miller(const Vector& a, const Vector& b, const Vector& c)
{
    return a + b + c + 9.0 / 20 * a.cross(c) + 27.0 / 40 * b.cross(c - a);
}

Vector four(const Vector& a, const Vector& b, const Vector& c, const Vector& d)
{
    return a + b + c + d + (54.0 / 105 * a + 92.0 / 105 * b + 214.0 / 105 * c).cross(d);
}

}  // namespace

Vector rotation_vector(std::span<const Sample> block, ClassicRule rule)
{
    assert(!block.empty() && block.size() <= 4);
    const auto th = [&](std::size_t i) -> const Vector& { return block[i].increment; };
    switch (block.size()) {
        case 1:
            return th(0);
        case 2:
            return two(th(0), th(1));
        case 3:
            return rule == ClassicRule::three_sample_miller ? three_miller(th(0), th(1), th(2)) : three(th(0), th(1), th(2));
        default:
            return four(th(0), th(1), th(2), th(3));
    }
}

std::size_t ClassicUpdate::block() const
{
    switch (rule_) {
        case ClassicRule::single:
        case ClassicRule::previous:
            return 1;
        case ClassicRule::two_sample:
            return 2;
        case ClassicRule::three_sample:
        case ClassicRule::three_sample_miller:
            return 3;
        case ClassicRule::four_sample:
            return 4;
    }
    return 1;
}

std::size_t ClassicUpdate::memory() const
{
    return rule_ == ClassicRule::single ? 1 : std::max<std::size_t>(block(), 2);
}

Step ClassicUpdate::step(std::uint64_t count, std::span<const Sample> recent) const
{
    const auto in_block = static_cast<std::size_t>((count - 1) % block()) + 1;
    if (in_block > 1) return {in_block, from_rotation_vector(rotation_vector(recent.last(in_block), rule_))};

    const bool alone = rule_ == ClassicRule::single || recent.size() < 2;
    return {1, from_rotation_vector(alone ? recent.back().increment : with_previous(recent[recent.size() - 2], recent.back()))};
}

}  // namespace quorient::attitude
