#pragma once

#include "field/allowance.hpp"
#include "quorient/fdi/instrument_array.hpp"

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace quorient::fdi::field {

inline constexpr std::size_t max_instruments = InstrumentArray::max_instruments;
inline constexpr std::size_t max_members = max_axes;  ///< in a comparison of any kind: instruments or single axes
inline constexpr std::size_t component_count = 3;  ///< x, y, z of the common frame

/// What a sound instrument may differ by from the others, per component: e = bias + gains' omega + delay * d omega/dt.
enum Parameter : Eigen::Index { bias, gain_x, gain_y, gain_z, delay, parameter_count };

using Parameters = Allowance<parameter_count>::Vector;
using Covariance = Allowance<parameter_count>::Matrix;
using PerInstrument = std::array<double, max_instruments>;

/// Which instruments, or which axes where single axes are compared; bit m stands for the one at place m.
class InstrumentSet {
public:
    constexpr InstrumentSet() = default;

    static constexpr InstrumentSet first(std::size_t count)
    {
        InstrumentSet set;
        set.bits_ = (1U << count) - 1;
        return set;
    }

    static constexpr InstrumentSet of(std::uint32_t bits) { return InstrumentSet(bits); }
    constexpr std::uint32_t bits() const { return bits_; }

    constexpr bool has(std::size_t m) const { return (bits_ >> m & 1U) != 0; }
    constexpr std::size_t size() const { return static_cast<std::size_t>(std::popcount(bits_)); }
    constexpr bool empty() const { return bits_ == 0; }
    constexpr void add(std::size_t m) { bits_ |= 1U << m; }
    constexpr void remove(std::size_t m) { bits_ &= ~(1U << m); }
    constexpr void set(std::size_t m, bool member) { member ? add(m) : remove(m); }

    friend constexpr InstrumentSet operator&(InstrumentSet a, InstrumentSet b) { return InstrumentSet(a.bits_ & b.bits_); }
    friend constexpr InstrumentSet operator|(InstrumentSet a, InstrumentSet b) { return InstrumentSet(a.bits_ | b.bits_); }
    friend constexpr InstrumentSet operator-(InstrumentSet a, InstrumentSet b) { return InstrumentSet(a.bits_ & ~b.bits_); }
    constexpr bool operator==(const InstrumentSet&) const = default;

private:
    constexpr explicit InstrumentSet(std::uint32_t bits) : bits_(bits) {}

    std::uint32_t bits_ = 0;
};

}  // namespace quorient::fdi::field
