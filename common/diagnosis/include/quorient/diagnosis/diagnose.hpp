#pragma once

#include "quorient/diagnosis/report.hpp"
#include "quorient/fdi/sensor_class.hpp"
#include "quorient/recording/resampler.hpp"
#include "quorient/recording/survey.hpp"

#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::diagnosis {

/// The compared instruments of a log on common intervals. Can be read again and again.
class Frames {
public:
    virtual ~Frames() = default;

    /// Calls `visit` with each frame, in order, from the log's beginning.
    virtual void each(const std::function<void(const recording::AlignedFrame&)>& visit) = 0;

    virtual double interval_s() const = 0;  ///< the usual one
};

/// What a healthy log says of one instrument: its measurement y stands for the rate  gain^-1 (y - bias)  along its own axes.
struct Calibration {
    std::string name;
    Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
    Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();  ///< takes its axes' components to those of the common frame
};

struct Options {
    fdi::SensorClass sensor_class = fdi::SensorClass::consumer;
    std::optional<fdi::Mount> mount;  ///< nothing: separate logs are separate boxes, instruments of one log are on one board
    std::vector<Calibration> reference;  ///< from a healthy log; empty = none
};

/// Finds which instruments of a log are faulty, how, and since when.
/// @param survey  of the log, with its clocks tied
/// @param frames  its compared instruments, axis 3 i + k = axis k of survey.compared[i]
Report diagnose(const recording::Survey& survey, Frames& frames, const Options& options);

/// Biases, gains and mountings of a log's instruments against each other, for the diagnosis of another log.
/// @returns an error where the log cannot serve: fewer than three instruments, an instrument outside its class, no motion and no rest.
tl::expected<std::vector<Calibration>, std::string> reference_of(const recording::Survey& survey, Frames& frames, const Options& options);

}  // namespace quorient::diagnosis
