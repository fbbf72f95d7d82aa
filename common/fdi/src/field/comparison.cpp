#include "field/comparison.hpp"

#include "field/dead_zone.hpp"
#include "field/frame_rules.hpp"
#include "field/order.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {
namespace {

constexpr double vibration_tolerance = 1.5;

double mean_of_others(const PerInstrument& values, InstrumentSet present, std::size_t m, std::size_t count)
{
    double sum = 0;
    for (std::size_t j = 0; j < count; ++j)
        if (j != m && present.has(j)) sum += values[j];
    return sum / static_cast<double>(present.size() - (present.has(m) ? 1 : 0));
}

}  // namespace

Comparison::Comparison(std::size_t instruments, double interval_s, Mount mount, const Allowed& allowed, const FieldRules& rules)
    : count_(instruments),
      interval_s_(interval_s),
      floor_(allowed.figures.noise_floor_rad_s),
      rules_(rules),
      learning_(instruments, allowed),
      noise_(instruments, floor_, interval_s),
      erratic_(instruments, interval_s)
{
    if (mount == Mount::structure) slow_.emplace(interval_s);
    noise_.leave_one_out = rules.leave_one_out;
}

void Comparison::reset()
{
    learning_.reset(false);
    noise_.reset();
    erratic_.reset();
    if (slow_) slow_->reset();
    sums_.clear();
    slow_sums_.clear();
}

Eigen::Vector3d Comparison::consensus(const Rates& rates, InstrumentSet present, const Eigen::Vector3d& last) const
{
    Parameters regressors;
    regressors << 1, last, 0;
    Eigen::Vector3d found;
    for (std::size_t c = 0; c < component_count; ++c) {
        PerInstrument values{};
        std::size_t n = 0;
        for (std::size_t m = 0; m < count_; ++m)
            if (present.has(m))
                values[n++] = rates(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(m)) - learning_.learned(c, m, regressors);
        found(static_cast<Eigen::Index>(c)) = median(values.data(), n);
    }
    return found;
}

Comparison::Deviation Comparison::deviation_of(std::size_t component, const Motion& motion, const Input& input)
{
    const auto c = static_cast<Eigen::Index>(component);
    const double dead = rules_.dead_zone ? 1 : 0;
    const double acceleration = (motion.step_before(c) + motion.step_after(c)) / (2 * interval_s_);
    const double noise = std::sqrt(noise_.typical(component));
    Deviation deviation;
    Parameters& phi = deviation.regressors;
    phi(bias) = 1;
    for (Eigen::Index k = 0; k < 3; ++k)
        phi(gain_x + k) = dead_zone(motion.rate(k), dead * rate_dead_zone * std::sqrt(noise_.typical(static_cast<std::size_t>(k))));
    phi(delay) = dead_zone(acceleration, dead * acceleration_dead_zone * noise / interval_s_);

    const double along = (motion.step_before(c) * motion.step_before(c) + motion.step_after(c) * motion.step_after(c)) / 2;
    const double all = (motion.step_before.squaredNorm() + motion.step_after.squaredNorm()) / 2;
    const double wander = wander_variance(along, all);
    noise_.reckon(component, wander, input.present);
    deviation.weight = frame_weight(wander, floor_);
    deviation.allowance = learning_.allowance(component, phi);
    clip(component, input, deviation);
    return deviation;
}

void Comparison::clip(std::size_t component, const Input& input, Deviation& deviation) const
{
    const auto c = static_cast<Eigen::Index>(component);
    PerInstrument sorted{};
    std::size_t n = 0;
    for (std::size_t m = 0; m < count_; ++m) {
        if (!input.present.has(m)) continue;
        deviation.raw[m] = input.rates(c, static_cast<Eigen::Index>(m)) - learning_.learned(component, m, deviation.regressors);
        sorted[n++] = deviation.raw[m];
    }
    const double middle = median(sorted.data(), n);
    for (std::size_t m = 0; m < count_; ++m) {
        if (!input.present.has(m)) continue;
        const double limit = clip_limit(deviation.allowance, noise_.own(component, m));
        deviation.raw[m] -= middle;
        deviation.clipped[m] = rules_.clipping ? std::clamp(deviation.raw[m], -limit, limit) : deviation.raw[m];
    }
    // Where an instrument has missed this frame, it says what the others say.
    for (std::size_t m = 0; m < count_; ++m)
        if (input.compared.has(m) && !input.present.has(m)) deviation.clipped[m] = mean_of_others(deviation.clipped, input.present, m, count_);
}

/// The instruments whose deviation no noise and no allowance explains, neither as it is nor without its mean: a shock's rebound is not one.
InstrumentSet Comparison::off(std::size_t component, const Deviation& deviation, const PerInstrument& quick, InstrumentSet present) const
{
    InstrumentSet found;
    if (present.size() < 3) return found;
    Parameters moving = deviation.regressors;
    moving(bias) = 0;
    const double vibration = slow_ ? vibration_tolerance * vibration_tolerance * slow_->vibration() / (off_sigmas * off_sigmas) : 0;
    const double quick_allowance = learning_.allowance(component, moving) + vibration;
    const double spread = off_sigmas * off_sigmas * (1 + 1 / static_cast<double>(present.size() - 1));
    for (std::size_t m = 0; m < count_; ++m) {
        if (!present.has(m)) continue;
        const double others = noise_.others(component, m);
        const double quick_difference = quick[m] - mean_of_others(quick, present, m, count_);
        const double difference = deviation.raw[m] - mean_of_others(deviation.raw, present, m, count_);
        const bool is_off = quick_difference * quick_difference > spread * (others + quick_allowance) &&
                            difference * difference > spread * (others + quick_allowance);
        if (is_off) found.add(m);
    }
    return found;
}

void Comparison::add_to(ComponentSums& sums, std::size_t component, const Deviation& deviation, InstrumentSet compared) const
{
    sums.weight = deviation.weight;
    sums.weight_squared = deviation.weight * deviation.weight;
    for (std::size_t m = 0; m < count_; ++m) sums.unclipped[m] = deviation.weight * deviation.raw[m];
    const std::array templates{1.0, deviation.regressors(parameter_of(Filter::gain, component)), deviation.regressors(delay)};
    for (std::size_t f = 0; f < filter_count; ++f) {
        const double weighted = deviation.weight * templates[f];
        FilterSums& filter = sums.filter[f];
        filter.regressors = weighted * deviation.regressors;
        for (std::size_t m = 0; m < count_; ++m) {
            if (!compared.has(m)) continue;
            filter.deviation[m] = weighted * deviation.clipped[m];
            filter.noise[m] = weighted * weighted * noise_.own(component, m);
            if (count_ == 3) filter.noise_of_others[m] = weighted * weighted * noise_.others(component, m);
        }
    }
}

PerInstrument Comparison::slow_residual(std::size_t component, const Motion& motion, const Deviation& deviation, InstrumentSet present)
{
    const auto c = static_cast<Eigen::Index>(component);
    PerInstrument whole{};
    for (std::size_t m = 0; m < count_; ++m)
        if (present.has(m)) whole[m] = deviation.clipped[m] + learning_.learned(component, m, deviation.regressors);
    Eigen::Vector3d noise;
    for (std::size_t k = 0; k < component_count; ++k) noise(static_cast<Eigen::Index>(k)) = std::sqrt(noise_.typical(k));
    const double acceleration = (motion.step_before(c) + motion.step_after(c)) / (2 * interval_s_);
    slow_->add(component, {motion.rate, acceleration, noise(c), noise}, present, whole);

    PerInstrument residual{};
    PerInstrument sorted{};
    std::size_t n = 0;
    for (std::size_t m = 0; m < count_; ++m) {
        if (!present.has(m)) continue;
        residual[m] = slow_->deviation(component, m) - learning_.learned(component, m, slow_->regressors(component));
        sorted[n++] = residual[m];
    }
    const double middle = median(sorted.data(), n);
    for (std::size_t m = 0; m < count_; ++m)
        if (present.has(m)) residual[m] -= middle;
    return residual;
}

void Comparison::add_slow(ComponentSums& sums, std::size_t component, double weight, const PerInstrument& residual,
                          InstrumentSet compared) const
{
    const Parameters& phi = slow_->regressors(component);
    for (const Filter filter : {Filter::gain, Filter::delay}) {
        const double weighted = weight * phi(parameter_of(filter, component));
        FilterSums& slow = sums.filter[static_cast<std::size_t>(filter)];
        slow.regressors = weighted * phi;
        for (std::size_t m = 0; m < count_; ++m) {
            if (!compared.has(m)) continue;
            slow.deviation[m] = weighted * residual[m];
            slow.noise[m] = weighted * weighted * noise_.own(component, m);
            if (count_ == 3) slow.noise_of_others[m] = weighted * weighted * noise_.others(component, m);
        }
    }
}

void Comparison::learn(std::size_t component, const Deviation& deviation, const PerInstrument& slow, InstrumentSet present)
{
    const double variance = noise_.typical(component);
    if (slow_)
        learning_.learn(component, slow_->regressors(component), present, slow, variance, std::max(usual_colour, slow_->colour()), interval_s_);
    else
        learning_.learn(component, deviation.regressors, present, deviation.raw, variance, usual_colour, interval_s_);
}

void Comparison::add(const Motion& motion, const Input& input)
{
    FrameSums sums{};
    FrameSums slow_sums{};
    std::array<InstrumentSet, component_count> off_frames;
    for (std::size_t c = 0; c < component_count; ++c) {
        if (input.blind[c]) continue;
        const Deviation deviation = deviation_of(c, motion, input);
        frame_bound_[c] = off_sigmas * std::sqrt(pair * (deviation.allowance + noise_.typical(c)));
        PerInstrument quick{};
        for (std::size_t m = 0; m < count_; ++m)
            if (input.present.has(m)) quick[m] = noise_.quick(c, m, deviation.raw[m]);
        off_frames[c] = off(c, deviation, quick, input.present);
        add_to(sums.component[c], c, deviation, input.compared);
        PerInstrument slow{};
        if (slow_) {
            slow = slow_residual(c, motion, deviation, input.present);
            add_slow(slow_sums.component[c], c, deviation.weight, slow, input.compared);
        }
        noise_.learn(c, input.present, quick, deviation.clipped);
        if (input.learns) learn(c, deviation, slow, input.present);
    }
    erratic_.add(off_frames);
    sums_.add(sums);
    if (slow_) slow_sums_.add(slow_sums);
}

}  // namespace quorient::fdi::field
