#include "block_update.hpp"

#include "window_update.hpp"

namespace quorient::attitude {

Step BlockUpdate::step(std::uint64_t count, std::span<const Sample> recent) const
{
    if (count < order_) return WindowUpdate(order_).step(count, recent);

    const Stretch stretch(recent);
    if (count % order_ != 0) return {1, stretch.rotation(recent.size() - 1)};

    Quaternion rotation = Quaternion::Identity();
    for (std::size_t i = 0; i < recent.size(); ++i) rotation = rotation * stretch.rotation(i);
    return {order_, renormalised(rotation)};
}

}  // namespace quorient::attitude
