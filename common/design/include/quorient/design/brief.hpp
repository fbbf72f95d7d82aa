#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// Which array to build: from what a builder has to the best arrays, and the bounds that none can pass.
namespace quorient::design {

/// Every instrument may point anywhere.
struct FreeMounting {};

/// All axes lie on one cone around z. Instruments of three right-angled axes stand with their diagonal along z, which is the cone of
/// half-angle acos(1/sqrt 3); those of two need a half-angle of at least 45 deg.
struct ConeMounting {
    std::optional<double> half_angle_rad{};  ///< absent: the search chooses it (single axes), or acos(1/sqrt 3) (instruments)
};

/// One face of a structure. A single axis points along its normal; an instrument stands on it with its z along the normal, its x turned
/// from the direction of the body's x as seen on the face (of the body's y where the face looks along x).
struct Face {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length
    double tolerance_rad = 0;                           ///< the normal may be tilted by so much, in any direction
    std::size_t holds = max_axes;                       ///< instruments at most
    std::vector<double> turns_rad{};                    ///< instruments may be turned about the normal by these; empty: by any
};

/// Every instrument stands on one of these faces.
struct FaceMounting {
    std::vector<Face> faces;
};

/// Every axis along x, y or z of the body.
struct RightAngleMounting {};

/// Every instrument stands on a wedge on the plate z = 0: turned about its own z, leant by the wedge's angle about y, turned to its azimuth.
struct WedgeMounting {
    std::vector<double> angles_rad;      ///< the wedges at hand, 0 = flat
    std::vector<double> azimuths_rad{};  ///< allowed; empty: any
    std::vector<double> turns_rad{};     ///< allowed, of the instrument on its wedge; empty: any
};

/// The array looks the same after a turn of 360 deg / order about an axis. A mirror is order 2 about its normal: axes are lines, and
/// the mirror image of a line is the line turned by 180 deg about the normal.
struct SymmetricMounting {
    Eigen::Vector3d about = Eigen::Vector3d::UnitZ();  ///< unit length
    unsigned order = 2;                                ///< 2 to 24
};

using Mounting = std::variant<FreeMounting, ConeMounting, FaceMounting, RightAngleMounting, WedgeMounting, SymmetricMounting>;

/// What must hold in the worst case after so many failures (0: with none); absent figures are free.
struct Limit {
    unsigned failures = 0;
    std::optional<double> trace{};
    std::optional<double> volume{};
    std::optional<double> condition{};
};

/// A part that takes several instruments with it: a supply, a board.
struct SharedPart {
    double failures_per_h = 0;
    std::vector<std::size_t> instruments;
};

/// How long the array has to serve, and how its parts fail: independently, at constant rates.
struct Mission {
    double hours = 0;
    double axis_failures_per_h = 0;
    double instrument_failures_per_h = 0;
    std::vector<SharedPart> shared{};
    double least_fault_sigma = 5;  ///< a failed axis is wrong by a constant of this size …
    double most_fault_sigma = 30;  ///< … to this one, uniformly, of either sign
    unsigned frames = 200;         ///< a fault that is not isolated within so many frames ends the mission
    std::string method{};          ///< as in the system file; empty: `vector` on four axes, else `subset`
    std::uint64_t trials = 10'000;  ///< missions played, with one failure at least
};

/// What a builder has and wants.
struct Brief {
    std::size_t instruments = 0;  ///< new ones
    unsigned axes_each = 1;       ///< 1; 2 or 3 at right angles (of two: x and y of the instrument, z its spin axis or package normal)
    std::vector<double> noise{};  ///< each new instrument's axes have this noise, any unit; empty: 1. Traces are in its square.
    geometry::Axes kept{0, 3};    ///< axes that are there already, of noise 1; they come first in the result
    std::vector<std::size_t> kept_instrument{};  ///< for each kept axis, from 0 without gaps; empty: each is an instrument of its own
    Mounting mounting = FreeMounting{};
    double minimum_angle_rad = 0;         ///< between any two axes of different instruments, as lines
    std::optional<unsigned> failures{};   ///< failures after which the array must still measure, one after another; arrays that name each come first
    bool instrument_faults = false;       ///< a failure takes a whole instrument
    unsigned detectable = 0;              ///< simultaneous faults to be detected whatever their sizes
    unsigned isolable = 0;                ///< … and isolated
    std::vector<Limit> limits{};
    std::optional<Mission> mission{};
    double mounting_error_rad = 0;  ///< every instrument is tilted by it in a random direction; 0: not considered

    std::size_t axis_count() const { return static_cast<std::size_t>(kept.rows()) + instruments * axes_each; }

    /// For each axis its instrument: those of kept axes first, new ones follow.
    std::vector<std::size_t> instrument_of_axes() const;

    /// The same demands with the least noise as the unit, for the search; as it is where axes of noise 1 are kept.
    Brief with_unit_noise() const;

    /// For each axis its noise.
    geometry::AxisVector noise_of_axes() const;

    /// Kept ones and new ones.
    std::size_t all_instruments() const { return kept_instruments() + instruments; }
    std::size_t kept_instruments() const;

    /// A failure takes several axes at once.
    bool fails_by_instrument() const { return instrument_faults && all_instruments() < axis_count(); }

    /// Single axes, or instruments of which a failure takes one axis: what may fail, one after another.
    std::size_t units() const;

    /// The failures after which figures are given: those demanded, else one and two where three axes would be left.
    unsigned judged_failures() const;
};

}  // namespace quorient::design
