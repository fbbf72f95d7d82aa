#pragma once

#include "quorient/attitude/integrator_settings.hpp"
#include "quorient/bus/reader_options.hpp"
#include "quorient/bus/settings.hpp"
#include "quorient/calibration/cluster_file.hpp"
#include "quorient/configuration/key.hpp"
#include "quorient/configuration/problems.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/fdi/observer_bank.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/unit_kind.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/runtime/realtime.hpp"
#include "quorient/simulation/simulated_instrument.hpp"
#include "quorient/simulation/vessel.hpp"
#include "quorient/voting/voter_settings.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::system {

/// `security` of the system file. common/security has the layout of the directory.
struct SecuritySettings {
    std::string directory;  ///< relative to the folder of the system file
    bus::SecurityLevel level = bus::SecurityLevel::none;
};

/// What every process of a system has.
struct ProcessSettings {
    runtime::NodeSettings node;
    bus::Settings bus;
    runtime::RealtimeSettings realtime;
    SecuritySettings security;
    bool spin = false;  ///< spin instead of blocking
};

/// A log played as if the sensors were here.
struct LogSettings {
    std::vector<std::string> files;  ///< several: instruments that logged one motion apart, merged by time
    double rest_s = 10;              ///< the log's beginning, at rest: biases and (without a calibration) sigmas come from it
    double from_s = 0;
    std::optional<double> to_s;
    bool of_imus = false;  ///< the axes are those of a robot's IMUs, whose names the log must have
    std::optional<double> stated_rate_hz;  ///< as the file says; its default is no claim about the log
};

/// One IMU of a robot, received as sensor_msgs/Imu.
struct Ros2ImuSettings {
    std::string topic;  ///< as DDS knows it
    std::string name;
    Eigen::Matrix3d mounting = Eigen::Matrix3d::Identity();  ///< IMU frame -> body frame
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();    ///< in the body frame
};

/// Several IMUs as one cluster.
struct Ros2SourceSettings {
    std::vector<Ros2ImuSettings> imus;
    double skew_s = 0.02;  ///< how far an IMU's stamps may be from those of the others, and how much later than them frames go out
    double rest_s = 2;      ///< rest at the start from which biases are learned; 0 = none are
};

struct SourceSettings {
    simulation::Scenario scenario;  ///< motion, rate, noise, faults; of a log only the faults and the seed count
    std::optional<LogSettings> log;
    std::optional<Ros2SourceSettings> ros2;
    std::optional<calibration::CalibratedCluster> calibration;  ///< for these very sensors; with a log or ros2
    std::optional<simulation::VesselScenario> vessel;  ///< in place of the scenario, of which then only the faults count
    double speed = 1;                                  ///< times real time
};

struct SensorSettings {
    ProcessSettings process;
    SourceSettings source;
    std::optional<geometry::SensorCluster> cluster;  ///< for a simulation; a log brings its own
    double range = 0;                                ///< that the file states, of every axis [rad/s; m/s^2]; 0 = none
    std::string unit_name;
    double wait_s = 5;  ///< for the consumers, then it goes on without them
    std::vector<std::string> consumers;
    std::optional<std::array<double, 4>> initial_attitude;  ///< absent: the simulation's own, unknown for a log
    std::optional<double> levelled_heading_rad;             ///< roll and pitch from the log's accelerometers at rest, this heading
    SensorKind kind = SensorKind::gyro;
};

/// Why a detector cannot serve a unit.
struct Unfit {
    std::string why;
    bool by_description = false;  ///< what the unit says of itself is wrong; else this detector does not suit it
};

struct DetectorProcess {
    ProcessSettings process;
    std::uint32_t lane = 0;
    std::uint32_t detector = 0;
    bus::Reach attitudes_from = bus::Reach::anywhere;
    SensorKind kind = SensorKind::gyro;
    fdi::DetectorSettings detection;
    std::optional<fdi::ObserverSettings> observers;  ///< for a vessel, in place of `detection`
    double observer_margin = 1;
    fdi::VerdictSettings verdict;

    /// Its brain, for a unit that describes itself so.
    tl::expected<fdi::FaultMonitor, Unfit> make_monitor(const ClusterDescription& description) const;
};

struct IntegratorProcess {
    ProcessSettings process;
    std::uint32_t detector = 0;  ///< whose verdicts count
    bus::Reach verdicts_from = bus::Reach::anywhere;
    double patience = 0.2;       ///< fraction of an interval that a frame waits for its verdict
    SensorKind kind = SensorKind::gyro;
    attitude::IntegratorSettings integration;
};

/// The voted attitude for ROS 2.
struct Ros2OutputSettings {
    std::string imu = "rt/imu/data";  ///< as DDS knows it
    std::string diagnostics = "rt/diagnostics";
    std::string frame_id = "base_link";
    std::uint32_t every = 1;   ///< n-th frame
    bool sample_time = false;  ///< stamps of the instrument's own clock in place of the host's
};

struct VoterProcess {
    ProcessSettings process;
    voting::VoterSettings voting;
    std::optional<Ros2OutputSettings> ros2;
};

/// The process that shows a system: a page, its state as JSON, figures for Prometheus. It is only started where the file has it.
struct MonitorProcess {
    ProcessSettings process;
    std::string address = "127.0.0.1";  ///< the web server's; anything but loopback only where stated
    std::uint32_t port = 8080;          ///< 0 = any free one
    bool allow_orders = false;          ///< faults, readmissions and resets from the page
    std::string token_file;  ///< holds the token that lets other hosts send orders (security/token.hpp), absolute; empty: this host alone sends them
};

/// What a run must show; `quorient launch` checks it against the simulator's truth and says so in its exit code.
struct Expectations {
    std::optional<AxisMask> isolated;            ///< exactly these axes, by every lane
    std::optional<std::string> instrument;       ///< exactly axes of this instrument, by every lane
    std::optional<std::uint32_t> within_frames;  ///< from the fault's first frame to each lane's isolation
    std::optional<double> final_error_rad;       ///< the voted attitude's, against truth
    bool no_gap = false;                         ///< the voted stream has none
    std::optional<double> each_fault_within_s;   ///< every fault of the truth is isolated by every lane so soon, and nothing else ever is

    bool any() const { return isolated || instrument || within_frames || final_error_rad || no_gap || each_fault_within_s; }
};

struct LaneProcess {
    std::string name;
    DetectorProcess detector;
    IntegratorProcess integrator;  ///< where the system has an attitude
};

/// Why processes cannot run in one.
struct Discord {
    std::size_t place = 0;  ///< that of the name that is to blame
    std::string why;
};

/// A whole system as its file describes it.
struct System {
    std::string file;
    std::string configuration;  ///< the file with every value that holds, as YAML; it reads back to the same system
    std::string name;
    std::uint32_t unit = 0;
    double interval_s = 0.005;
    SensorSettings sensor;
    std::vector<LaneProcess> lanes;
    std::vector<VoterProcess> voters;
    ProcessSettings monitor;  ///< for tools that look on
    std::optional<MonitorProcess> web_monitor;
    Expectations expectations;
    std::vector<std::vector<std::string>> compositions;  ///< names of processes that run in one
    std::optional<simulation::VesselModel> vessel;  ///< for a unit of kind vessel_rates: what the detectors take it to be
    std::vector<std::string> channels;              ///< likewise, their names

    /// All processes of the file, in the order in which they start: those first that receive from the others.
    std::vector<const ProcessSettings*> processes() const;

    /// The process of that name; nothing if there is none.
    const ProcessSettings* process(std::string_view wanted) const;

    /// What keeps these processes from running in one; nothing if they can.
    std::optional<Discord> discord_of(const std::vector<std::string>& names) const;

    /// Whether these names hold the whole lane of this detector: the detector and its integrator.
    bool holds_lane(std::uint32_t detector, const std::vector<std::string>& names) const;

    /// One for each lane; none where the unit gives no attitude.
    std::vector<const IntegratorProcess*> integrators() const;

    /// Else faults are looked for, and nothing is integrated: no integrators, no voters.
    bool has_attitude() const { return unit_kind(sensor.kind).gives_attitude; }

    /// The process of that name; an error that lists the names of this role.
    tl::expected<DetectorProcess, std::string> detector(std::string_view process) const;
    tl::expected<IntegratorProcess, std::string> integrator(std::string_view process) const;
    tl::expected<VoterProcess, std::string> voter(std::string_view process) const;
};

/// What the command line sets in place of the file.
struct Overrides {
    std::optional<Vendor> dds{};  ///< for every process
    std::optional<std::uint32_t> domain{};
    std::vector<std::string> processes{};  ///< those that run here: only their networks and keys are checked; empty = every one
    std::vector<std::string> set{};  ///< `source.speed=2`, `source.faults+=axis=1,kind=zero`: as configuration::assign takes them
    bool joins = true;               ///< false: no process joins the bus, so no keys are needed
    bool any_host = false;           ///< neither networks nor keys are checked: the processes run on other hosts

    bool concerns(std::string_view process) const;
};

/// Reads a system file. @returns every problem of the file at once.
tl::expected<System, configuration::Problems> judge(const std::string& file, const Overrides& overrides = {});

/// The same. @returns the problems as text: one per line with file:line:column, and how many there are.
tl::expected<System, std::string> load(const std::string& file, const Overrides& overrides = {});

/// All keys of a system file, and the page docs/system-file.md that is made of them.
configuration::Chapter reference();
std::string reference_page();

}  // namespace quorient::system
