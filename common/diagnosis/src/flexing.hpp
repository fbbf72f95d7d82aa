#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace quorient::diagnosis {

/// Distinguishes one board from separate boxes on a frame that flexes: on a board an instrument's gain against the others is the same at all frequencies,
/// on a structure each box sees a vibration of its own.
class Flexing {
public:
    explicit Flexing(std::size_t instruments) : axes_(3 * instruments) {}

    /// One instrument in one frame, along its axes [rad/s].
    void add(std::size_t instrument, double interval_s, const Eigen::Vector3d& measured, const Eigen::Vector3d& others);

    /// The largest ratio of the gain above 5 Hz to that below, beyond or below 1, of any axis that vibrated enough to tell. Nothing: none did.
    struct Ratio {
        std::size_t instrument = 0;
        std::size_t axis = 0;
        double ratio = 1;
        std::size_t differing = 0;  ///< axes whose ratio leaves 1 by more than a tenth
    };
    std::optional<Ratio> largest() const;

private:
    struct Band {
        double products = 0;  ///< measured times others
        double squares = 0;   ///< those of the others

        double gain() const { return products / squares; }
    };
    struct Axis {
        double low_measured = 0;
        double low_others = 0;
        double frames = 0;
        bool fast = false;  ///< sampled fast enough
        Band low;
        Band high;
    };

    std::vector<Axis> axes_;
};

}  // namespace quorient::diagnosis
