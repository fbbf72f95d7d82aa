#include "quorient/design/brief.hpp"

#include <algorithm>

namespace quorient::design {

namespace {

constexpr std::size_t least_axes = 3;
constexpr unsigned usual_failures = 2;

}  // namespace

std::vector<std::size_t> Brief::instrument_of_axes() const
{
    std::vector<std::size_t> instrument = kept_instrument;
    if (instrument.empty())
        for (std::size_t axis = 0; axis < kept_instruments(); ++axis) instrument.push_back(axis);
    for (std::size_t index = 0; index < instruments; ++index) instrument.insert(instrument.end(), axes_each, kept_instruments() + index);
    return instrument;
}

std::size_t Brief::kept_instruments() const
{
    return kept_instrument.empty() ? static_cast<std::size_t>(kept.rows()) : std::ranges::max(kept_instrument) + 1;
}

geometry::AxisVector Brief::noise_of_axes() const
{
    geometry::AxisVector all = geometry::AxisVector::Ones(static_cast<Eigen::Index>(axis_count()));
    if (noise.empty()) return all;
    const auto before = static_cast<std::size_t>(kept.rows());
    for (std::size_t axis = before; axis < axis_count(); ++axis)
        all(static_cast<Eigen::Index>(axis)) = noise[std::min((axis - before) / axes_each, noise.size() - 1)];
    return all;
}

Brief Brief::with_unit_noise() const
{
    Brief scaled = *this;
    if (noise.empty() || kept.rows() > 0) return scaled;
    const double unit = std::ranges::min(noise);
    for (double& one : scaled.noise) one /= unit;
    for (Limit& limit : scaled.limits) {
        if (limit.trace) *limit.trace /= unit * unit;
        if (limit.volume) *limit.volume /= unit * unit * unit;
    }
    return scaled;
}

std::size_t Brief::units() const
{
    return fails_by_instrument() ? all_instruments() : axis_count();
}

unsigned Brief::judged_failures() const
{
    if (failures) return *failures;
    const auto owners = instrument_of_axes();
    const auto size_of = [&](std::size_t owner) { return static_cast<std::size_t>(std::ranges::count(owners, owner)); };
    std::size_t taken = 1;
    for (const std::size_t owner : owners) taken = std::max(taken, fails_by_instrument() ? size_of(owner) : 1);
    const std::size_t spare = axis_count() > least_axes ? (axis_count() - least_axes) / taken : 0;
    return static_cast<unsigned>(std::min<std::size_t>(usual_failures, spare));
}

}  // namespace quorient::design
