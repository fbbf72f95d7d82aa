#include "field/diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::fdi::field {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A deviation that so many standard deviations of estimate and class do not explain is one.
constexpr double significant_sigmas = 3;

/// A gain is known once its standard deviation is below this; a direction likewise [rad].
constexpr double known_gain = 0.1;

/// An axis that measures along another direction, with about the right scale.
constexpr double turned_by = 20 * degree;
constexpr double reversed_by = 150 * degree;
constexpr double right_scale = 0.3;

/// Rounding of rates [rad/s].
constexpr double exactly = 1e-9;

/// Noise is named where it is so many times what is expected, spikes where they are at most this share of the frames.
constexpr double noisy = 3;
constexpr double spikes_share = 0.2;
constexpr std::size_t least_spikes = 3;

AxisDiagnosis with_size(Diagnosis kind, const AxisFit::Estimate& size, double reference)
{
    AxisDiagnosis diagnosis;
    diagnosis.kind = kind;
    diagnosis.size = size.value;
    diagnosis.sigma = std::hypot(size.sigma, reference);
    return diagnosis;
}

AxisDiagnosis with_bias(AxisDiagnosis diagnosis, const AxisFit& fit, const Diagnostics::Context& context)
{
    if (diagnosis.kind == Diagnosis::none) return {};
    diagnosis.bias = fit.solution().bias.value;
    diagnosis.bias_sigma = std::hypot(fit.solution().bias.sigma, context.reference(bias));
    return diagnosis;
}

bool exceeds(double deviation, double sigma, double allowed)
{
    return std::abs(deviation) > significant_sigmas * std::hypot(sigma, allowed);
}

}  // namespace

Diagnostics::Diagnostics(const geometry::SensorCluster& cluster, const InstrumentArray& array, const geometry::Axes& axes,
                         const Learning::Allowed& allowed)
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

void Diagnostics::judge(std::size_t m, const Context& context)
{
    bool any = false;
    for (std::size_t i = 0; i < array_[m].size; ++i) {
        const std::size_t axis = array_[m].axis[i];
        of_[axis] = proved_by(fit_[axis], axes_.row(static_cast<Eigen::Index>(axis)).dot(context.zero), context);
        any = any || of_[axis].kind != Diagnosis::none;
    }
    const std::size_t blamed = blamed_axis(m);
    if (!any) of_[blamed] = blamed_for(fit_[blamed], blame_[m].kind, context);
}

/// What the fit itself proves, the most specific explanation first.
AxisDiagnosis Diagnostics::proved_by(const AxisFit& fit, double zero, const Context& context) const
{
    const ClassFigures& figures = allowed_.figures;
    const AxisFit::Solution& found = fit.solution();
    const double unknown_bias = allowed_.calibrated ? figures.bias_calibrated_rad_s : figures.bias_unknown_rad_s;
    const double usual_gain = allowed_.calibrated ? figures.gain_calibrated : figures.gain;
    const bool known = found.gain.sigma < known_gain;
    const bool turned = known && found.turned.sigma < known_gain && found.turned.value > turned_by && std::abs(found.length - 1) < right_scale;
    AxisDiagnosis diagnosis;
    if (fit.is_constant() && known && std::abs(found.gain.value) < known_gain)
        diagnosis.kind = std::abs(fit.last() - zero) < exactly ? Diagnosis::zero : Diagnosis::stuck;
    else if (turned && found.turned.value > reversed_by)
        diagnosis = with_size(Diagnosis::sign, found.gain, context.reference(gain_x));
    else if (turned)
        diagnosis = with_size(Diagnosis::mounting, found.turned, context.reference(gain_x));
    else if (known && exceeds(found.gain.value - 1, found.gain.sigma, usual_gain))
        diagnosis = with_size(Diagnosis::gain, found.gain, context.reference(gain_x));
    else if (exceeds(found.delay.value, found.delay.sigma, allowed_.delay_s))
        diagnosis = with_size(Diagnosis::delay, found.delay, context.reference(delay));
    else if (exceeds(found.bias.value, found.bias.sigma, context.rested ? figures.bias_after_rest_rad_s : unknown_bias))
        diagnosis = with_size(Diagnosis::bias, found.bias, context.reference(bias));
    return with_bias(diagnosis, fit, context);
}

/// Where the fit proves nothing yet: the rule's own reason, with the size that the fit has for it.
AxisDiagnosis Diagnostics::blamed_for(const AxisFit& fit, Diagnosis kind, const Context& context) const
{
    const AxisFit::Solution& found = fit.solution();
    const bool spikes = fit.spikes() >= least_spikes && static_cast<double>(fit.spikes()) < spikes_share * static_cast<double>(fit.frames());
    AxisDiagnosis diagnosis;
    if (kind == Diagnosis::gain)
        diagnosis = with_size(kind, found.gain, context.reference(gain_x));
    else if (kind == Diagnosis::delay)
        diagnosis = with_size(kind, found.delay, context.reference(delay));
    else if (kind != Diagnosis::erratic)
        diagnosis = with_size(kind, found.bias, context.reference(bias));
    else if (spikes)
        diagnosis = with_size(Diagnosis::spikes, {fit.mean_spike(), 0}, 0);
    else if (found.noise > noisy * context.usual_noise)
        diagnosis = with_size(Diagnosis::noise, {found.noise / context.usual_noise, 0}, 0);
    else if (exceeds(found.bias.value, found.bias.sigma, 0))
        diagnosis = with_size(Diagnosis::bias, found.bias, context.reference(bias));
    else
        diagnosis.kind = kind;
    return with_bias(diagnosis, fit, context);
}

}  // namespace quorient::fdi::field
