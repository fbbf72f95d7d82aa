#include "field_fault.hpp"

#include "quorient/messages/units.hpp"

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

namespace quorient::studies {
namespace {

constexpr double least_noise = 0.06 * degree;
constexpr double full_scale = 2000 * degree;
constexpr std::size_t samples_per_spike = 200;
constexpr double on_s = 0.3;  ///< in every second
constexpr double first_onset_s = 2;
constexpr double last_onset = 0.85;  ///< share in the log's length

constexpr std::array faults{
    FieldFault{.name = "bias 2", .spoil = Spoil::bias, .size = 2 * degree, .kind = Diagnosis::bias},
    FieldFault{.name = "bias 5", .spoil = Spoil::bias, .size = 5 * degree, .kind = Diagnosis::bias},
    FieldFault{.name = "bias 10", .spoil = Spoil::bias, .size = 10 * degree, .kind = Diagnosis::bias},
    FieldFault{.name = "bias 22.9", .spoil = Spoil::bias, .size = 22.9 * degree, .kind = Diagnosis::bias},
    FieldFault{.name = "bias 60", .spoil = Spoil::bias, .size = 60 * degree, .kind = Diagnosis::bias},
    FieldFault{.name = "gain 0.8", .spoil = Spoil::gain, .size = 0.8, .turning = true, .kind = Diagnosis::gain},
    FieldFault{.name = "sign", .spoil = Spoil::sign, .turning = true, .kind = Diagnosis::sign},
    FieldFault{.name = "stuck", .spoil = Spoil::stuck, .turning = true, .kind = Diagnosis::stuck},
    FieldFault{.name = "delay of one sample", .spoil = Spoil::delay, .turning = true, .whole = true, .kind = Diagnosis::delay},
    FieldFault{.name = "noise x10", .spoil = Spoil::noise, .size = 10, .kind = Diagnosis::noise},
    FieldFault{.name = "ramp 0.5 deg/s^2", .spoil = Spoil::ramp, .size = 0.5 * degree, .kind = Diagnosis::bias},
    FieldFault{.name = "mounting turned by 90", .spoil = Spoil::mounting, .turning = true, .whole = true, .kind = Diagnosis::mounting},
    FieldFault{.name = "half rate", .spoil = Spoil::half_rate, .turning = true, .whole = true, .kind = Diagnosis::delay},
    FieldFault{.name = "20 deg/s, 0.3 of every 1 s", .spoil = Spoil::alternating, .size = 20 * degree, .kind = Diagnosis::erratic},
    FieldFault{.name = "shock 20, 0.01 s", .spoil = Spoil::bias, .size = 20 * degree, .lasts_s = 0.01, .passes = true},
    FieldFault{.name = "shock 100, 0.08 s", .spoil = Spoil::bias, .size = 100 * degree, .lasts_s = 0.08, .passes = true},
    FieldFault{.name = "shock 150, 0.08 s", .spoil = Spoil::bias, .size = 150 * degree, .lasts_s = 0.08, .passes = true},
    FieldFault{.name = "dropout 0.4 s", .spoil = Spoil::dropout, .lasts_s = 0.4, .passes = true},
    FieldFault{.name = "dropout 2 s", .spoil = Spoil::dropout, .lasts_s = 2, .passes = true},
    FieldFault{.name = "full scale in 1 of 200", .spoil = Spoil::full_scale, .passes = true},
};

constexpr double turning_rate = 10 * degree;
constexpr double half_second = 0.5;
constexpr int half_seconds = 4;
constexpr int most_draws = 400;

double time_s(const SensorFrame& frame)
{
    return static_cast<double>(frame.sample_time_ns) * 1e-9;
}

/// The rate that the median instrument measures along a component [rad/s].
double median_rate(const FieldLog& log, const SensorFrame& frame, std::size_t component)
{
    std::vector<double> rates;
    for (std::size_t axis = component; axis < log.cluster.size(); axis += 3)
        if (has_axis(frame.valid_mask, axis)) rates.push_back(frame.increment[axis] / frame.interval_s);
    if (rates.empty()) return 0;
    const auto middle = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2);
    std::ranges::nth_element(rates, middle);
    return *middle;
}

/// In each half second of the next two.
bool turns_after(const FieldLog& log, std::size_t onset)
{
    std::array<double, half_seconds> squares{};
    std::array<double, half_seconds> frames{};
    const double begin = time_s(log.frames[onset]);
    for (std::size_t k = onset; k < log.frames.size(); ++k) {
        const auto place = static_cast<std::size_t>((time_s(log.frames[k]) - begin) / half_second);
        if (place >= squares.size()) break;
        for (std::size_t c = 0; c < 3; ++c) squares[place] += std::pow(median_rate(log, log.frames[k], c), 2);
        ++frames[place];
    }
    for (std::size_t i = 0; i < squares.size(); ++i)
        if (!(squares[i] > turning_rate * turning_rate * std::max(1.0, frames[i]))) return false;
    return true;
}

}  // namespace

std::span<const FieldFault> field_faults()
{
    return faults;
}

double sample_noise(const FieldLog& log)
{
    std::vector<double> steps;
    const AxisMask both = log.cluster.axes_of(0) | log.cluster.axes_of(1);
    for (std::size_t k = 1; k < log.frames.size(); ++k) {
        const SensorFrame& before = log.frames[k - 1];
        const SensorFrame& now = log.frames[k];
        if ((before.valid_mask & now.valid_mask & both) != both) continue;
        const auto difference = [](const SensorFrame& f, std::size_t c) { return (f.increment[c] - f.increment[3 + c]) / f.interval_s; };
        for (std::size_t c = 0; c < 3; ++c) steps.push_back(std::abs(difference(now, c) - difference(before, c)) / 2);
    }
    if (steps.empty()) return least_noise;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    constexpr double normal_from_median = 1.4826;
    return std::max(least_noise, normal_from_median * *middle);
}

Injection draw(const FieldLog& log, const FieldFault& fault, double noise_rad_s, std::mt19937_64& random)
{
    boost::random::uniform_01<double> uniform;
    const auto below = [&](std::size_t n) { return std::min(n - 1, static_cast<std::size_t>(uniform(random) * static_cast<double>(n))); };
    Injection injection{.fault = fault, .noise_rad_s = noise_rad_s};
    injection.instrument = below(log.instruments());
    injection.axis = 3 * injection.instrument + below(3);
    injection.sign = uniform(random) < 0.5 ? -1 : 1;
    const double begin = time_s(log.frames.front());
    for (int tried = 0; tried < most_draws; ++tried) {
        const double at = begin + first_onset_s + uniform(random) * std::max(0.0, last_onset * log.duration_s() - first_onset_s);
        const auto onset = std::ranges::lower_bound(log.frames, at, {}, time_s);
        injection.onset = static_cast<std::size_t>(onset - log.frames.begin());
        if (!fault.turning || turns_after(log, injection.onset)) break;
    }
    return injection;
}

Spoiler::Spoiler(const FieldLog& log, const Injection& injection, std::uint64_t seed)
    : log_(log), injection_(injection), random_(seed), begin_s_(time_s(log.frames[injection.onset]))
{
    for (std::size_t i = 0; i < 3; ++i) axes_[i] = 3 * injection.instrument + i;
}

bool Spoiler::active(std::size_t place) const
{
    return place >= injection_.onset && time_s(log_.frames[place]) < begin_s_ + injection_.fault.lasts_s - 1e-6;
}

void Spoiler::apply(std::size_t place, SensorFrame& frame)
{
    if (active(place)) spoil(place, frame);
}

void Spoiler::spoil(std::size_t place, SensorFrame& frame)
{
    const FieldFault& fault = injection_.fault;
    const double dt = frame.interval_s;
    const double since = time_s(frame) - begin_s_;
    double& value = frame.increment[injection_.axis];
    const auto rate_before = [&](std::size_t axis) {
        const SensorFrame& before = log_.frames[place > 0 ? place - 1 : 0];
        return before.increment[axis] / before.interval_s;
    };
    switch (fault.spoil) {
        case Spoil::bias: value += injection_.sign * fault.size * dt; break;
        case Spoil::gain: value *= fault.size; break;
        case Spoil::sign: value = -value; break;
        case Spoil::stuck: {
            const SensorFrame& first = log_.frames[injection_.onset];
            value = first.increment[injection_.axis] / first.interval_s * dt;
            break;
        }
        case Spoil::delay:
            for (const std::size_t axis : axes_) frame.increment[axis] = rate_before(axis) * dt;
            break;
        case Spoil::noise: {
            boost::random::normal_distribution<double> noise(0, fault.size * injection_.noise_rad_s);
            value += noise(random_) * dt;
            break;
        }
        case Spoil::ramp: value += injection_.sign * fault.size * since * dt; break;
        case Spoil::dropout:
            for (const std::size_t axis : axes_) frame.valid_mask &= ~axis_bit(axis);
            break;
        case Spoil::full_scale:
            if ((place - injection_.onset) % samples_per_spike == 0) value = -full_scale * dt;
            break;
        case Spoil::half_rate:
            if ((place - injection_.onset) % 2 == 1)
                for (const std::size_t axis : axes_) frame.increment[axis] = rate_before(axis) * dt;
            break;
        case Spoil::mounting: {
            const double first = frame.increment[axes_[0]];
            frame.increment[axes_[0]] = frame.increment[axes_[1]];
            frame.increment[axes_[1]] = -first;
            break;
        }
        case Spoil::alternating:
            if (since - std::floor(since) < on_s) value += injection_.sign * fault.size * dt;
            break;
    }
}

}  // namespace quorient::studies
