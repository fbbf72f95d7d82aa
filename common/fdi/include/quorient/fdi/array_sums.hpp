#pragma once

#include "quorient/fdi/instrument_array.hpp"
#include "quorient/fdi/settings.hpp"

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace quorient::fdi {

/// What to expect of an array that was calibrated: fractions of its interval and of its own noise, as the two MIMU4444 recordings
/// show them (docs/methods/arrays.md). Negligible beside the noise where the motion is gentle.
/// @param level  multiplies all that moving brings in: 1 for arrays like those, else what a recording of the array shows.
MotionNoise usual_motion_noise(const geometry::SensorCluster& cluster, double level = 1);

/// What every instrument of an array has measured over windows of past frames, and how well they must agree.
///
/// Per frame k instrument m gives theta_m = B_m z_m, with error covariance C_m (noise at rest) + M_k (motion),
///   M_k = h^2 [(tau_a^2 - tau_c^2) a a' + tau_c^2 |a|^2 I] + S_k,   a = d omega / dt,
/// the known wildness of a violent motion, which lies along a. S_k = sum (range/2)^2 b_i b_i' over the axes i near their range in this
/// frame or the one before (the sensor's filter remembers): along them nothing is known, across them the frame counts.
/// Each frame is weighted by W_k = c (C + M_k)^-1, C the mean of C_m: the same for all instruments (clipping each alone would destroy
/// isolation), so that sums over a window still agree:
///   y_m = sum W_k theta_m,k = (sum W_k theta_k) + e_m,
///   cov e_m = c W + sum W_k (C_m - C) W_k + floors + outliers,     W = sum W_k
///   floors: bias_floor, rate_error |omega| and axes_error omega, summed as a constant error would be;
///   outliers: kappa^2 max over the window of (|W_k| rough_k)^2, rough_k the lately largest |a| h.
/// Across a turn what little is certain then counts fully, and in the calm moments all of it.
///
/// Gated sums: where an instrument contradicts the mean of the others by a chi-square beyond the gate, W_k is less by the factor of the
/// two, again the same for all instruments. c W then bounds the covariance of what is left: sum W_k (C + M_k) W_k <= c W.
///
/// Each frame waits for its successor, which gives the acceleration after it: one frame of delay.
class ArraySums {
public:
    static constexpr std::size_t longest_window = 512;  ///< frames
    static constexpr double gate_tail = 1e-3;           ///< a frame of noise alone is beyond the detector's gate this often

    enum class Added {
        unusable,  ///< an axis that is compared has no value: the windows go on behind this frame
        waits,     ///< for its successor
        counted,   ///< the frame before was counted in
    };

    /// What one instrument contradicts the others by.
    struct Contradiction {
        Eigen::Vector3d u;  ///< R_m^-1 (y_m - y), R_m = cov e_m, y the common rotation's estimate
        Eigen::Matrix3d q;  ///< cov u
    };

    /// One window: all instruments' common rotation.
    struct Fit {
        std::array<Eigen::Matrix3d, InstrumentArray::max_instruments> information;  ///< R_m^-1
        std::array<Eigen::Vector3d, InstrumentArray::max_instruments> value;        ///< y_m
        Eigen::Matrix3d weight;                                                     ///< W
        Eigen::Matrix3d covariance;                                                 ///< y's
        Eigen::Vector3d fused;                                                      ///< y
        std::array<Eigen::Matrix3d, InstrumentArray::max_instruments> contrast;     ///< (cov (y_m - y))^-1 = (R_m - cov y)^-1

        Contradiction contradiction(std::size_t instrument) const;
        /// u' Q^-1 u of three degrees of freedom: no error of this instrument alone can explain more.
        double chi_square(std::size_t instrument) const;
    };

    /// @param gate  chi-square of three degrees of freedom; absent: all frames count fully.
    ArraySums(const InstrumentArray& array, const MotionNoise& motion, std::optional<double> gate = {});

    const InstrumentArray& array() const { return array_; }
    void exclude(AxisMask excluded);
    void reset();

    Added add(const Measurement& measurement);

    std::size_t size() const { return size_; }        ///< frames counted since the last reset, as far as they are kept
    std::uint64_t counted() const { return count_; }  ///< frames ever

    /// @param window  1 .. min(size() - 1, longest_window) frames up to the newest one counted.
    Fit fit(std::size_t window) const;

    /// Over the instruments that are compared.
    double largest_chi_square(std::size_t window) const;

    /// Sequence of the first frame of this window.
    std::uint64_t begin_of(std::size_t window) const { return total(window - 1).sequence; }

    /// Axes near their range in the newest frame or in the one before.
    AxisMask saturated() const { return near_range_ | near_range_before_; }

private:
    static constexpr std::size_t history_length = 1024;
    static_assert(history_length > longest_window);

    /// A frame that waits for its successor.
    struct Pending {
        std::uint64_t sequence = 0;
        double interval_s = 0;
        AxisMask saturated = 0;
        InstrumentArray::BodyVectors body{};  ///< theta_m
        Eigen::Vector3d rate = Eigen::Vector3d::Zero();
        Eigen::Vector3d acceleration_before = Eigen::Vector3d::Zero();
    };

    /// Running totals over the frames counted; a window is the difference of two.
    struct Totals {
        InstrumentArray::BodyVectors sum{};                ///< W_k theta_m
        Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();  ///< W_k
        Eigen::Matrix3d biased = Eigen::Matrix3d::Zero();  ///< W_k h
        Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();  ///< W_k |omega| h
        std::array<Eigen::Matrix3d, 3> rotated{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(),
                                               Eigen::Matrix3d::Zero()};      ///< W_k omega_j h
        std::array<Eigen::Matrix3d, InstrumentArray::max_instruments> own{};  ///< W_k (C_m - C) W_k, of a kind
        std::uint64_t sequence = 0;
    };

    Pending pending_of(const Measurement& measurement) const;
    void count_in(const Pending& frame, const Eigen::Vector3d& acceleration_after);
    Eigen::Matrix3d motion_covariance(const Pending& frame, const Eigen::Vector3d& acceleration_after, double blow, double rough) const;
    double share_of(const Pending& frame, const Eigen::Matrix3d& information) const;
    Eigen::Matrix3d common_covariance(std::size_t window) const;
    std::size_t place(std::size_t age) const { return (next_ + history_length - 1 - age) % history_length; }
    const Totals& total(std::size_t age) const { return totals_[place(age)]; }

    InstrumentArray array_;
    MotionNoise motion_;
    std::optional<double> gate_;
    double scale_;                   ///< c: W_k has trace 3 at rest
    std::vector<Totals> totals_;     ///< ring
    std::vector<double> roughness_;  ///< ring; of each frame alone, weighted: |W_k|^2 times the square that roughness_s^2 multiplies
    std::size_t next_ = 0;
    std::size_t size_ = 0;
    std::uint64_t count_ = 0;
    AxisMask near_range_ = 0;
    AxisMask near_range_before_ = 0;
    std::optional<Pending> pending_;
    double wildness_ = 0;  ///< |d omega/dt|^2, slow to fall
};

}  // namespace quorient::fdi
