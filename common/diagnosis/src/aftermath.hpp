#pragma once

#include "array.hpp"
#include "flexing.hpp"
#include "own_evidence.hpp"
#include "watch.hpp"

#include "quorient/diagnosis/report.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <optional>
#include <vector>

namespace quorient::diagnosis {

/// What shows once it is known which instruments are faulty: noise against the sound ones in motion, when a fault ended, and how far the
/// attitudes with and without the faulty instrument part.
class Aftermath {
public:
    /// @param faulty  by the detector; the first one is the one that attitudes are compared for
    Aftermath(const Array& array, const std::vector<Isolation>& faulty);

    void add(const recording::AlignedFrame& frame);
    void finish();

    /// Standard deviation of one frame's difference to the sound others about its mean over a second, along the instrument's axes [rad/s]:
    /// the median over all seconds with motion.
    std::optional<Eigen::Vector3d> noise_in_motion(std::size_t m) const;

    /// When the instrument was sound again, to the log's end; nothing where it stayed faulty or where nothing shows it.
    std::optional<double> ended(std::size_t place) const;

    const OwnEvidence& own_evidence() const { return own_evidence_; }
    const Flexing& flexing() const { return flexing_; }
    const std::optional<AttitudeDifference>& attitude() const { return attitude_; }

    /// In the newest frame [deg]; 0 before the fault.
    double with_deg() const { return with_deg_; }
    double alone_deg() const { return alone_deg_; }

private:
    /// One instrument in one second, along its axes: its difference to the others, and the rate.
    struct Second {
        double frames = 0;
        Eigen::Vector3d difference = Eigen::Vector3d::Zero();
        Eigen::Vector3d squares = Eigen::Vector3d::Zero();
        Eigen::Vector3d rate_products = Eigen::Vector3d::Zero();  ///< difference times rate
        Eigen::Vector3d rate = Eigen::Vector3d::Zero();
        Eigen::Vector3d rate_squares = Eigen::Vector3d::Zero();
    };

    /// The watch for the end of one fault.
    struct End {
        double baseline_frames = 0;
        Eigen::Vector3d baseline = Eigen::Vector3d::Zero();  ///< sum of the differences before the fault
        std::optional<double> sound_since_s;
        unsigned sound_seconds = 0;
    };

    void compare(const recording::AlignedFrame& frame);
    void end_second();
    void watch_end(std::size_t place, const Second& second);
    void integrate(const recording::AlignedFrame& frame);

    const Array& array_;
    const std::vector<Isolation>& faulty_;
    std::uint32_t sound_ = 0;
    OwnEvidence own_evidence_;
    Flexing flexing_;
    std::vector<OwnEvidence::Compared> compared_;  ///< in the newest frame
    double second_begin_s_ = 0;
    double last_s_ = 0;
    bool begun_ = false;
    std::vector<Second> seconds_;
    std::vector<Decimated<Eigen::Vector3f>> noise_;
    std::vector<End> ends_;
    rotation::Quaternion all_ = rotation::Quaternion::Identity();
    rotation::Quaternion without_ = rotation::Quaternion::Identity();
    rotation::Quaternion alone_ = rotation::Quaternion::Identity();
    double with_deg_ = 0;
    double alone_deg_ = 0;
    std::optional<AttitudeDifference> attitude_;
};

}  // namespace quorient::diagnosis
