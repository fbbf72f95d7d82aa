#pragma once

#include "field/erratic.hpp"
#include "field/learning.hpp"
#include "field/low_pass.hpp"
#include "field/noise_scale.hpp"
#include "field/window_sums.hpp"
#include "field/field_detector.hpp"

#include <optional>

namespace quorient::fdi::field {

/// A frame's consensus and its neighbours'.
struct Motion {
    Eigen::Vector3d rate;         ///< omega [rad/s]
    Eigen::Vector3d step_before;  ///< omega_k - omega_k-1
    Eigen::Vector3d step_after;   ///< omega_k+1 - omega_k
};

/// One frame after the other: what each instrument measures beyond the consensus, in units that the matched filters sum.
///
///   e_m = x_m - theta_m' phi,   d_m = clip(e_m - median e),   phi = [1, dz(omega), dz(alpha)]
///
/// dz: dead zone. The frame's weight w falls where the motion makes the differences uncertain.
class Comparison {
public:
    using Rates = Eigen::Matrix<double, 3, max_instruments>;

    Comparison(std::size_t instruments, double interval_s, Mount mount, const Allowed& allowed, const FieldRules& rules);

    void reset();

    /// The median of what the present instruments measure without their learned differences.
    /// @param last  the consensus before
    Eigen::Vector3d consensus(const Rates& rates, InstrumentSet present, const Eigen::Vector3d& last) const;

    struct Input {
        const Rates& rates;          ///< biases of the start taken out [rad/s]
        InstrumentSet compared;      ///< take part in the comparison
        InstrumentSet present;       ///< have data in this frame
        std::array<bool, component_count> blind{};
        bool learns = false;
    };

    /// Adds one frame to the sums.
    void add(const Motion& motion, const Input& input);

    const WindowSums& sums() const { return sums_; }
    const WindowSums* slow_sums() const { return slow_ ? &slow_sums_ : nullptr; }
    const Erratic& erratic() const { return erratic_; }
    Learning& learning() { return learning_; }
    const Learning& learning() const { return learning_; }
    const NoiseScale& noise() const { return noise_; }

    /// What an instrument's deviation stays below in one frame while it is sound [rad/s].
    double frame_bound(std::size_t component) const { return frame_bound_[component]; }

private:
    /// The comparison of one component.
    struct Deviation {
        Parameters regressors;
        double weight;
        double allowance;
        PerInstrument raw{};
        PerInstrument clipped{};
    };

    Deviation deviation_of(std::size_t component, const Motion& motion, const Input& input);
    void clip(std::size_t component, const Input& input, Deviation& deviation) const;
    InstrumentSet off(std::size_t component, const Deviation& deviation, const PerInstrument& quick, InstrumentSet present) const;
    void add_to(ComponentSums& sums, std::size_t component, const Deviation& deviation, InstrumentSet compared) const;
    PerInstrument slow_residual(std::size_t component, const Motion& motion, const Deviation& deviation, InstrumentSet present);
    void add_slow(ComponentSums& sums, std::size_t component, double weight, const PerInstrument& residual, InstrumentSet compared) const;
    void learn(std::size_t component, const Deviation& deviation, const PerInstrument& slow, InstrumentSet present);

    std::size_t count_;
    double interval_s_;
    double floor_;  ///< the least noise of one frame [rad/s]
    FieldRules rules_;
    Learning learning_;
    NoiseScale noise_;
    Erratic erratic_;
    std::optional<SlowPart> slow_;
    WindowSums sums_;
    WindowSums slow_sums_;
    std::array<double, component_count> frame_bound_{};
};

}  // namespace quorient::fdi::field
