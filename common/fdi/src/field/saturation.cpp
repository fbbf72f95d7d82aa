#include "field/saturation.hpp"

#include <cmath>

namespace quorient::fdi::field {
namespace {

/// The frame itself and the three after it, whose derivatives it spoils.
constexpr unsigned frames_blinded = 4;

constexpr double borne_out_at = 0.8;  ///< of the range

/// An axis touches a component that it has this share in; two axes point alike above the second one.
constexpr double touching = 0.1;
constexpr double alike = 0.5;

}  // namespace

Saturation::Saturation(const geometry::SensorCluster& cluster, const geometry::Axes& axes) : cluster_(cluster), axes_(axes) {}

void Saturation::reset()
{
    blind_frames_.fill(0);
    limited_ = {};
    common_ = false;
}

bool Saturation::borne_out(std::size_t axis, const Frame& frame, InstrumentSet compared, const Eigen::Vector3d& consensus) const
{
    const auto row = axes_.row(static_cast<Eigen::Index>(axis));
    if (std::abs(row.dot(consensus)) > borne_out_at * cluster_.range(static_cast<Eigen::Index>(axis))) return true;
    for (std::size_t other = 0; other < cluster_.size(); ++other) {
        if (!has_axis(frame.near_range, other) || cluster_.instrument[other] == cluster_.instrument[axis]) continue;
        if (compared.has(cluster_.instrument[other]) && std::abs(row.dot(axes_.row(static_cast<Eigen::Index>(other)))) > alike) return true;
    }
    return false;
}

void Saturation::update(const Frame& frame, InstrumentSet compared, const Eigen::Vector3d& consensus)
{
    std::array<InstrumentSet, component_count> beyond;
    std::array<InstrumentSet, component_count> believed_beyond;
    std::array<bool, component_count> blinded{};
    for (std::size_t axis = 0; frame.near_range != 0 && axis < cluster_.size(); ++axis) {
        const std::size_t m = cluster_.instrument[axis];
        if (!has_axis(frame.near_range, axis) || !compared.has(m) || !frame.present.has(m)) continue;
        const bool believed = borne_out(axis, frame, compared, consensus);
        for (std::size_t c = 0; c < component_count; ++c) {
            const double share = std::abs(axes_(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(c)));
            if (share < touching) continue;
            blinded[c] = blinded[c] || believed;
            if (share <= alike) continue;
            beyond[c].add(m);
            if (believed) believed_beyond[c].add(m);
        }
    }
    common_ = false;
    limited_ = {};
    for (std::size_t c = 0; c < component_count; ++c) {
        const InstrumentSet here = compared & frame.present;
        const bool all = here.size() >= 2 && beyond[c] == here;
        common_ = common_ || all;
        if (!all) limited_ = limited_ | believed_beyond[c];
        if (blinded[c]) blind_frames_[c] = frames_blinded;
        else if (blind_frames_[c] > 0) --blind_frames_[c];
    }
}

}  // namespace quorient::fdi::field
