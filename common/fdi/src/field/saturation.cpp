#include "field/saturation.hpp"

#include "field/order.hpp"

#include <cmath>

namespace quorient::fdi::field {
namespace {

/// The frame itself and the three after it, whose derivatives it spoils.
constexpr unsigned frames_blinded = 4;

constexpr double borne_out_at = 0.8;  ///< as a part of the range

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

bool Saturation::is_exceeded(std::size_t axis, const Frame& frame, InstrumentSet compared) const
{
    const auto row = axes_.row(static_cast<Eigen::Index>(axis));
    InstrumentSet free = compared & frame.present;
    for (std::size_t other = 0; other < cluster_.size(); ++other)
        if (has_axis(frame.near_range, other) && std::abs(row.dot(axes_.row(static_cast<Eigen::Index>(other)))) > touching)
            free.remove(cluster_.instrument[other]);
    PerInstrument rates{};
    std::size_t n = 0;
    for (std::size_t m = 0; m < max_instruments; ++m)
        if (free.has(m)) rates[n++] = row.dot(frame.rate.col(static_cast<Eigen::Index>(m)));
    return n > 0 && std::abs(median(rates.data(), n)) > cluster_.range(static_cast<Eigen::Index>(axis));
}

void Saturation::update(const Frame& frame, InstrumentSet compared, const Eigen::Vector3d& consensus)
{
    std::array<InstrumentSet, component_count> beyond;
    limited_ = {};
    std::array<bool, component_count> blinded{};
    for (std::size_t axis = 0; frame.near_range != 0 && axis < cluster_.size(); ++axis) {
        const std::size_t m = cluster_.instrument[axis];
        if (!has_axis(frame.near_range, axis) || !compared.has(m) || !frame.present.has(m)) continue;
        const bool believed = borne_out(axis, frame, compared, consensus);
        if (believed && is_exceeded(axis, frame, compared)) limited_.add(m);
        for (std::size_t c = 0; c < component_count; ++c) {
            const double share = std::abs(axes_(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(c)));
            if (share < touching) continue;
            blinded[c] = blinded[c] || believed;
            if (share > alike) beyond[c].add(m);
        }
    }
    common_ = false;
    for (std::size_t c = 0; c < component_count; ++c) {
        const InstrumentSet here = compared & frame.present;
        common_ = common_ || (here.size() >= 2 && beyond[c] == here);
        if (blinded[c]) blind_frames_[c] = frames_blinded;
        else if (blind_frames_[c] > 0) --blind_frames_[c];
    }
}

}  // namespace quorient::fdi::field
