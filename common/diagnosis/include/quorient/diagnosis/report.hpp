#pragma once

#include "quorient/fdi/sensor_class.hpp"
#include "quorient/recording/survey.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::diagnosis {

/// What is wrong with an instrument or an axis.
enum class Kind {
    bias,       ///< deg/s too much
    gain,       ///< reads this share of the true rate
    sign,       ///< reads the true rate with the wrong sign
    delay,      ///< s late
    stuck,      ///< repeats one value while the vehicle turns
    zero,       ///< stuck at exactly 0
    saturated,  ///< at its range
    noise,      ///< times its usual noise
    spikes,     ///< single samples, deg/s
    mounting,   ///< turned against the others, deg
    outside_class,  ///< differs by more than sound sensors of its class do, deg/s
    time,       ///< its time stamps step back, s
    missing,    ///< has no data for so long, s
    unit,       ///< its numbers are so many times too large
};
std::string_view name_of(Kind kind);
std::string_view unit_of(Kind kind);

enum class Certainty {
    isolated,   ///< this instrument, and no other
    detected,   ///< something is wrong; candidates say where it may be
    transient,  ///< it passed by itself
};
std::string_view name_of(Certainty certainty);

/// Places an instrument among those of the report.
using InstrumentIndex = std::size_t;

struct Finding {
    std::optional<InstrumentIndex> instrument;  ///< nothing: no single one is to blame
    std::optional<std::size_t> axis;            ///< 0, 1, 2 of the instrument; nothing: the whole instrument
    Kind kind = Kind::bias;
    double size = std::numeric_limits<double>::quiet_NaN();         ///< in unit_of(kind); not finite where it is not known
    double uncertainty = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of the size; not finite where it is not known
    std::optional<double> bias_deg_s;  ///< what the axis reads too much besides, where a kind other than bias is the finding
    double from_s = 0;                 ///< since the log's beginning
    std::optional<double> to_s;        ///< nothing: to the end of the log
    Certainty certainty = Certainty::detected;
    std::vector<InstrumentIndex> candidates;
    std::string remark;  ///< "looks like 90 degrees about z"
};

/// Figures of one instrument. Vectors are along its own axes.
struct InstrumentFacts {
    std::string name;
    recording::InstrumentFigures figures;
    recording::ClockFigures clock;
    bool compared = false;
    std::optional<Eigen::Vector3d> bias_deg_s;  ///< mean at rest, or where there is no rest, against the others
    bool bias_from_rest = false;
    std::optional<Eigen::Vector3d> gain;            ///< against the others
    std::optional<Eigen::Quaterniond> rotation;     ///< takes its axes' components to those of the common frame
    std::optional<Eigen::Vector3d> noise_rest_deg_s;    ///< standard deviation of one frame
    std::optional<Eigen::Vector3d> noise_motion_deg_s;  ///< the same for its difference to the others, without what is slower than 1 s
};

/// What another autopilot's published rule makes of the same log.
struct PeerFinding {
    std::string rule;     ///< PX4, ArduPilot
    std::string finding;  ///< a sentence
    std::optional<double> at_s;
};

/// A stretch of the log for drawing.
struct PlotBin {
    struct Instrument {
        Eigen::Vector3f least_deg_s = Eigen::Vector3f::Zero();  ///< in the common frame
        Eigen::Vector3f largest_deg_s = Eigen::Vector3f::Zero();
        float residual_deg_s = 0;  ///< the largest deviation from the others' consensus, of any axis and frame
        float bound_deg_s = 0;     ///< what it stays below in one frame while the instrument is sound
        unsigned frames = 0;
    };
    std::vector<Instrument> of;  ///< the compared ones
    float with_deg = 0;          ///< attitude by all instruments against that by the sound ones
    float alone_deg = 0;         ///< attitude by the faulty instrument alone against that by the sound ones
    bool filled = false;
};

struct Plot {
    double first_s = 0;
    double bin_s = 0;
    std::vector<PlotBin> bins;
};

struct AttitudeDifference {
    InstrumentIndex left_out = 0;
    double with_deg = 0;   ///< largest angle between the attitude by all and that without the faulty instrument, since its fault began
    double alone_deg = 0;  ///< largest angle between the attitude by the faulty instrument alone and that by the others
};

struct Rest {
    double from_s = 0;
    double to_s = 0;
};

/// The logger paused: no instrument has data.
struct Hole {
    double from_s = 0;
    double to_s = 0;
};

struct Report {
    std::string log;
    std::string sentence;
    double duration_s = 0;
    double coverage = 0;  ///< least share of the motion that a compared instrument holds
    fdi::Mount mount = fdi::Mount::board;
    std::vector<InstrumentFacts> instruments;
    std::vector<Finding> findings;  ///< the weightiest first
    std::vector<PeerFinding> peers;
    std::optional<AttitudeDifference> attitude;
    std::vector<Rest> rests;
    std::vector<Hole> holes;  ///< each 10 s or longer
    std::vector<std::string> remarks;
    Plot plot;

    /// The duration without the holes.
    double logged_s() const;

    /// Two instruments or more hold enough of the motion for a verdict.
    bool judged() const;

    /// Something that did not pass by itself.
    bool found_anything() const;
};

}  // namespace quorient::diagnosis
