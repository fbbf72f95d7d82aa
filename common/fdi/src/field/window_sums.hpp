#pragma once

#include "field/parameters.hpp"
#include "field/running_sums.hpp"

#include <array>
#include <vector>

namespace quorient::fdi::field {

/// What a fault would look like: a constant, in proportion to the rate, in proportion to its derivative.
enum class Filter : std::uint8_t { bias, gain, delay };

inline constexpr std::size_t filter_count = 3;

/// The parameter that this filter looks for, in this component.
constexpr Parameter parameter_of(Filter filter, std::size_t component)
{
    switch (filter) {
        case Filter::gain: return static_cast<Parameter>(static_cast<std::size_t>(gain_x) + component);
        case Filter::delay: return delay;
        case Filter::bias: break;
    }
    return bias;
}

/// Sums over frames k of one component through one filter with the template t.
struct FilterSums {
    Parameters regressors = Parameters::Zero();  ///< w t phi: what a unit error of each parameter would contribute
    PerInstrument deviation{};                   ///< w t d_m
    PerInstrument noise{};                       ///< w^2 t^2 V_m
    std::array<double, 3> noise_of_others{};     ///< w^2 t^2 V of the pair without m, where three instruments are compared

    FilterSums& operator+=(const FilterSums& other)
    {
        regressors += other.regressors;
        for (std::size_t m = 0; m < max_instruments; ++m) {
            deviation[m] += other.deviation[m];
            noise[m] += other.noise[m];
        }
        for (std::size_t m = 0; m < noise_of_others.size(); ++m) noise_of_others[m] += other.noise_of_others[m];
        return *this;
    }

    FilterSums& operator-=(const FilterSums& other)
    {
        regressors -= other.regressors;
        for (std::size_t m = 0; m < max_instruments; ++m) {
            deviation[m] -= other.deviation[m];
            noise[m] -= other.noise[m];
        }
        for (std::size_t m = 0; m < noise_of_others.size(); ++m) noise_of_others[m] -= other.noise_of_others[m];
        return *this;
    }
};

struct ComponentSums {
    double weight = 0;
    double weight_squared = 0;
    PerInstrument unclipped{};  ///< w e_m: deviations as they are
    std::array<FilterSums, filter_count> filter{};

    ComponentSums& operator+=(const ComponentSums& other)
    {
        weight += other.weight;
        weight_squared += other.weight_squared;
        for (std::size_t m = 0; m < max_instruments; ++m) unclipped[m] += other.unclipped[m];
        for (std::size_t f = 0; f < filter_count; ++f) filter[f] += other.filter[f];
        return *this;
    }

    ComponentSums& operator-=(const ComponentSums& other)
    {
        weight -= other.weight;
        weight_squared -= other.weight_squared;
        for (std::size_t m = 0; m < max_instruments; ++m) unclipped[m] -= other.unclipped[m];
        for (std::size_t f = 0; f < filter_count; ++f) filter[f] -= other.filter[f];
        return *this;
    }
};

template <class Part>
struct OfComponents {
    std::array<Part, component_count> component{};

    OfComponents& operator+=(const OfComponents& other)
    {
        for (std::size_t c = 0; c < component_count; ++c) component[c] += other.component[c];
        return *this;
    }

    OfComponents& operator-=(const OfComponents& other)
    {
        for (std::size_t c = 0; c < component_count; ++c) component[c] -= other.component[c];
        return *this;
    }
};

inline constexpr std::size_t longest_window = 512;
inline constexpr std::size_t ring_length = longest_window + 8;

using FrameSums = OfComponents<ComponentSums>;
using WindowSums = RunningSums<FrameSums, ring_length>;

}  // namespace quorient::fdi::field
