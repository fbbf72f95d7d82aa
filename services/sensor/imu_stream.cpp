#include "imu_stream.hpp"

#include <algorithm>

namespace quorient::sensor {

bool ImuStream::add(const ImuSample& sample)
{
    if (count_ > 0 && sample.stamp_ns <= newest().stamp_ns) return false;
    samples_[count_++ % capacity] = sample;
    return true;
}

bool ImuStream::integrate(std::int64_t begin_ns, std::int64_t end_ns, std::int64_t longest_gap_ns, Eigen::Vector3d& integral) const
{
    if (count_ == 0 || newest().stamp_ns < end_ns || at(oldest()).stamp_ns > begin_ns) return false;
    std::size_t later = count_ - 1;
    while (later > oldest() && at(later - 1).stamp_ns >= end_ns) --later;
    integral.setZero();
    for (; later > oldest() && at(later).stamp_ns > begin_ns; --later) {
        const auto& a = at(later - 1);
        const auto& b = at(later);
        const auto gap_ns = b.stamp_ns - a.stamp_ns;
        if (gap_ns > longest_gap_ns) return false;
        const auto value_at = [&](std::int64_t time_ns) -> Eigen::Vector3d {
            return a.value + (b.value - a.value) * (static_cast<double>(time_ns - a.stamp_ns) / static_cast<double>(gap_ns));
        };
        const auto from_ns = std::max(a.stamp_ns, begin_ns);
        const auto to_ns = std::min(b.stamp_ns, end_ns);
        integral += (value_at(from_ns) + value_at(to_ns)) * (0.5e-9 * static_cast<double>(to_ns - from_ns));
    }
    return true;
}

}  // namespace quorient::sensor
