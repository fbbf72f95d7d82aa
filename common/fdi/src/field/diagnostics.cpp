#include "field/diagnostics.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {
Diagnostics::Diagnostics(const geometry::SensorCluster& cluster, const InstrumentArray& array, const geometry::Axes& axes,
                         const Allowed& allowed)
    : cluster_(cluster), array_(array), axes_(axes), allowed_(allowed)
{
}

void Diagnostics::reset()
{
    for (std::size_t m = 0; m < array_.size(); ++m) acquit(m);
}

void Diagnostics::accuse(std::size_t m, const Blame& blame)
{
    if (accused_.has(m)) {
        if (blame.kind != Diagnosis::none) blame_[m] = blame;
        return;
    }
    accused_.add(m);
    blame_[m] = blame;
    for (std::size_t i = 0; i < array_[m].size; ++i) {
        const std::size_t axis = array_[m].axis[i];
        fit_[axis].begin(axes_.row(static_cast<Eigen::Index>(axis)).transpose(), allowed_.figures.noise_floor_rad_s);
        of_[axis] = {};
    }
    of_[blamed_axis(m)].kind = blame.kind;
}

void Diagnostics::acquit(std::size_t m)
{
    accused_.remove(m);
    for (std::size_t i = 0; i < array_[m].size; ++i) {
        fit_[array_[m].axis[i]].forget();
        of_[array_[m].axis[i]] = {};
    }
}

/// The axis of the instrument that points most along the component that the rule blamed.
std::size_t Diagnostics::blamed_axis(std::size_t m) const
{
    const auto share = [&](std::size_t axis) {
        return std::abs(axes_(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(blame_[m].component)));
    };
    const auto* const begin = array_[m].axis.begin();
    return *std::max_element(begin, begin + array_[m].size, [&](std::size_t a, std::size_t b) { return share(a) < share(b); });
}

void Diagnostics::add(std::size_t m, const Eigen::Vector3d& measured, const Eigen::Vector3d& rate, const Eigen::Vector3d& acceleration)
{
    for (std::size_t i = 0; i < array_[m].size; ++i) {
        const std::size_t axis = array_[m].axis[i];
        fit_[axis].add(axes_.row(static_cast<Eigen::Index>(axis)).dot(measured), rate, acceleration);
    }
}

void Diagnostics::judge(std::size_t m, const Eigen::Vector3d& zero, const DiagnosisContext& context)
{
    bool any = false;
    for (std::size_t i = 0; i < array_[m].size; ++i) {
        const std::size_t axis = array_[m].axis[i];
        of_[axis] = proved_by(fit_[axis], allowed_, axes_.row(static_cast<Eigen::Index>(axis)).dot(zero), context);
        any = any || of_[axis].kind != Diagnosis::none;
    }
    const std::size_t blamed = blamed_axis(m);
    if (!any) of_[blamed] = blamed_for(fit_[blamed], blame_[m].kind, context);
}

}  // namespace quorient::fdi::field
