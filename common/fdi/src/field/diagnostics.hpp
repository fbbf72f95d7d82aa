#pragma once

#include "field/axis_fit.hpp"
#include "field/learning.hpp"
#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

namespace quorient::fdi::field {

/// Which rule accused an instrument, and where: what is said of its kind until the fit knows better.
struct Blame {
    std::size_t component = 0;
    Diagnosis kind = Diagnosis::none;
};

/// Kind and size of what is wrong with accused instruments, axis by axis: the accused one against the others, from the accusation on and, so that
/// the figures converge, after its isolation.
class Diagnostics {
public:
    Diagnostics(const geometry::SensorCluster& cluster, const InstrumentArray& array, const geometry::Axes& axes, const Learning::Allowed& allowed);

    void reset();

    /// An accusation begins, unless one is under way; then the newer blame counts.
    void accuse(std::size_t m, const Blame& blame);

    /// The instrument is trusted again.
    void acquit(std::size_t m);

    bool accused(std::size_t m) const { return accused_.has(m); }

    /// @param rate, acceleration  of the others
    /// @param measured  of this instrument [rad/s]
    void add(std::size_t m, const Eigen::Vector3d& measured, const Eigen::Vector3d& rate, const Eigen::Vector3d& acceleration);

    struct Context {
        bool rested = false;      ///< the instrument's bias was known
        double usual_noise = 0;   ///< of one frame [rad/s]
        Eigen::Vector3d zero;     ///< what the instrument's measurement is where it reads exactly 0 [rad/s]
        Parameters reference;     ///< standard deviations of what the others' mean may be wrong by
    };
    void judge(std::size_t m, const Context& context);

    const AxisDiagnosis& of(std::size_t axis) const { return of_[axis]; }

private:
    AxisDiagnosis proved_by(const AxisFit& fit, double zero, const Context& context) const;
    AxisDiagnosis blamed_for(const AxisFit& fit, Diagnosis kind, const Context& context) const;
    std::size_t blamed_axis(std::size_t m) const;

    const geometry::SensorCluster& cluster_;
    const InstrumentArray& array_;
    const geometry::Axes& axes_;
    Learning::Allowed allowed_;
    InstrumentSet accused_;
    std::array<Blame, max_instruments> blame_{};
    std::array<AxisFit, max_axes> fit_{};
    std::array<AxisDiagnosis, max_axes> of_{};
};

}  // namespace quorient::fdi::field
