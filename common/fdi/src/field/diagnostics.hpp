#pragma once

#include "field/axis_diagnosis.hpp"
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
    Diagnostics(const geometry::SensorCluster& cluster, const InstrumentArray& array, const geometry::Axes& axes, const Allowed& allowed);

    void reset();

    /// An accusation begins, unless one is under way; then the newer blame counts.
    void accuse(std::size_t m, const Blame& blame);

    /// The instrument is trusted again.
    void acquit(std::size_t m);

    bool accused(std::size_t m) const { return accused_.has(m); }

    /// @param rate, acceleration  of the others
    /// @param measured  of this instrument [rad/s]
    void add(std::size_t m, const Eigen::Vector3d& measured, const Eigen::Vector3d& rate, const Eigen::Vector3d& acceleration);

    /// @param zero  what the instrument's measurement is where it reads exactly 0 [rad/s]
    void judge(std::size_t m, const Eigen::Vector3d& zero, const DiagnosisContext& context);

    const AxisDiagnosis& of(std::size_t axis) const { return of_[axis]; }

private:
    std::size_t blamed_axis(std::size_t m) const;

    const geometry::SensorCluster& cluster_;
    const InstrumentArray& array_;
    const geometry::Axes& axes_;
    Allowed allowed_;
    InstrumentSet accused_;
    std::array<Blame, max_instruments> blame_{};
    std::array<AxisFit, max_axes> fit_{};
    std::array<AxisDiagnosis, max_axes> of_{};
};

}  // namespace quorient::fdi::field
