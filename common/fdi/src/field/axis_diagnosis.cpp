#include "field/axis_diagnosis.hpp"

#include "quorient/messages/units.hpp"

#include <cmath>

namespace quorient::fdi::field {
namespace {

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

AxisDiagnosis with_bias(AxisDiagnosis diagnosis, const AxisFit& fit, const DiagnosisContext& context)
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

AxisDiagnosis proved_by(const AxisFit& fit, const Allowed& allowed, double zero, const DiagnosisContext& context)
{
    const AxisFit::Solution& found = fit.solution();
    const bool known = found.gain.sigma < known_gain;
    const bool turned = known && found.turned.sigma < known_gain && found.turned.value > turned_by && std::abs(found.length - 1) < right_scale;
    AxisDiagnosis diagnosis;
    if (fit.is_constant() && known && std::abs(found.gain.value) < known_gain)
        diagnosis.kind = std::abs(fit.last() - zero) < exactly ? Diagnosis::zero : Diagnosis::stuck;
    else if (turned && found.turned.value > reversed_by)
        diagnosis = with_size(Diagnosis::sign, found.gain, context.reference(gain_x));
    else if (turned)
        diagnosis = with_size(Diagnosis::mounting, found.turned, context.reference(gain_x));
    else if (known && exceeds(found.gain.value - 1, found.gain.sigma, allowed.gain()))
        diagnosis = with_size(Diagnosis::gain, found.gain, context.reference(gain_x));
    else if (exceeds(found.delay.value, found.delay.sigma, allowed.delay_s))
        diagnosis = with_size(Diagnosis::delay, found.delay, context.reference(delay));
    else if (exceeds(found.bias.value, found.bias.sigma, allowed.bias(context.rested)))
        diagnosis = with_size(Diagnosis::bias, found.bias, context.reference(bias));
    return with_bias(diagnosis, fit, context);
}

AxisDiagnosis blamed_for(const AxisFit& fit, Diagnosis kind, const DiagnosisContext& context)
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
