#include "quorient/design/mission.hpp"

#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Core>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr std::uint64_t trials_of_block = 250;
constexpr unsigned quiet_frames = 12;          // before each fault: warm-up
constexpr unsigned predictor_history = 40;     // the same on four axes
constexpr double interval_s = 0.01;
constexpr double turn_per_frame_sigma = 1000;
constexpr double change_of_direction_rad = 0.005;  // per frame
constexpr std::size_t four_axes = 4;

/// Something that fails at a constant rate.
struct Part {
    double failures_per_h = 0;
    AxisMask axes = 0;
    bool silent = false;  ///< its axes are missing from then on, instead of being wrong
};

std::vector<Part> parts_of(const geometry::SensorCluster& cluster, const Mission& mission)
{
    std::vector<Part> parts;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) parts.push_back({mission.axis_failures_per_h, axis_bit(axis), false});
    for (std::size_t index = 0; index < cluster.instrument_name.size(); ++index)
        parts.push_back({mission.instrument_failures_per_h, cluster.axes_of(index), false});
    for (const SharedPart& shared : mission.shared) {
        Part part{shared.failures_per_h, 0, true};
        for (const std::size_t index : shared.instruments) part.axes |= cluster.axes_of(index);
        parts.push_back(part);
    }
    std::erase_if(parts, [](const Part& part) { return part.failures_per_h <= 0; });
    return parts;
}

double total_rate(const std::vector<Part>& parts)
{
    double sum = 0;
    for (const Part& part : parts) sum += part.failures_per_h;
    return sum;
}

/// Where one failure takes a whole instrument, a detector has to isolate whole instruments.
bool isolates_instruments(const geometry::SensorCluster& cluster, const Mission& mission)
{
    return mission.instrument_failures_per_h > 0 && cluster.instrument_name.size() < cluster.size();
}

fdi::DetectorSettings detector_settings(const geometry::SensorCluster& cluster, const Mission& mission)
{
    fdi::DetectorSettings settings;
    settings.method = !mission.method.empty() ? mission.method : cluster.size() == four_axes ? "vector" : "subset";
    settings.instruments = isolates_instruments(cluster, mission);
    return settings;
}

using Monitor = tl::expected<fdi::FaultMonitor, std::string>;

Monitor make_monitor(const geometry::SensorCluster& cluster, const Mission& mission)
{
    return fdi::FaultMonitor::make(detector_settings(cluster, mission), {}, cluster);
}

/// What became of the missions of one block.
struct Tally {
    std::uint64_t missions = 0;
    std::uint64_t survived = 0;
    std::vector<std::uint64_t> reached;   ///< first, second, … failures that had to be isolated
    std::vector<std::uint64_t> isolated;  ///< … and were

    void count(std::size_t place, bool right)
    {
        if (reached.size() <= place) {
            reached.resize(place + 1, 0);
            isolated.resize(place + 1, 0);
        }
        ++reached[place];
        isolated[place] += right ? 1 : 0;
    }
};

/// One mission: the array, its detector, and what has failed so far.
class Play {
public:
    Play(const geometry::SensorCluster& cluster, const Mission& mission, std::mt19937_64& random)
        : cluster_(cluster), mission_(mission), random_(random), monitor_(make_monitor(cluster, mission)), phase_(direction_(random))
    {
        for (Vector3d& axis : plane_)
            for (double& part : axis) part = normal_(random);
        plane_[0].normalize();
        plane_[1] = plane_[1].cross(plane_[0]).normalized();
    }

    /// Whether the mission goes on after this part has failed.
    bool survives(const Part& part, Tally& tally)
    {
        const AxisMask working = cluster_.all() & ~failed_;
        const AxisMask newly = part.axes & working;
        if (newly == 0) return true;
        if (!monitor_) return false;  // three axes
        const unsigned quiet = cluster_.size() == four_axes ? predictor_history : quiet_frames;
        for (unsigned frame = 0; frame < quiet; ++frame) next_frame();
        fail(part, newly);
        const bool isolated = part.silent || is_isolated(newly);
        if (!part.silent) tally.count(place_++, isolated);
        return isolated && geometry::rank_of(cluster_.axes, cluster_.all() & ~failed_) == 3;
    }

private:
    void fail(const Part& part, AxisMask newly)
    {
        boost::random::uniform_real_distribution<double> size(mission_.least_fault_sigma, mission_.most_fault_sigma);
        for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
            if (!has_axis(newly, axis)) continue;
            const double sign = normal_(random_) < 0 ? -1 : 1;
            wrong_by_[axis] = part.silent ? 0 : sign * size(random_) * cluster_.sigma(static_cast<Index>(axis));
        }
        if (part.silent) missing_ |= newly;
        failed_ |= isolates_instruments(cluster_, mission_) ? whole_instruments(newly) : newly;
    }

    AxisMask whole_instruments(AxisMask axes) const
    {
        AxisMask all = 0;
        for (std::size_t index = 0; index < cluster_.instrument_name.size(); ++index)
            if (const AxisMask own = cluster_.axes_of(index); (own & axes) != 0) all |= own;
        return all;
    }

    /// All of it, and never anything sound.
    bool is_isolated(AxisMask newly)
    {
        for (unsigned frame = 0; frame < mission_.frames; ++frame) {
            const AxisMask isolated = next_frame();
            if ((isolated & ~failed_) != 0) return false;
            if ((newly & ~isolated) == 0) return true;
        }
        return false;
    }

    AxisMask next_frame()
    {
        frame_.epoch = 1;
        ++frame_.sequence;
        frame_.interval_s = interval_s;
        frame_.axis_count = static_cast<std::uint8_t>(cluster_.size());
        frame_.valid_mask = cluster_.all() & ~missing_;
        Vector3d turn = Vector3d::Zero();
        if (cluster_.size() == four_axes) {
            const double angle = phase_ + change_of_direction_rad * static_cast<double>(frame_.sequence);
            turn = turn_per_frame_sigma * cluster_.sigma.minCoeff() * (std::cos(angle) * plane_[0] + std::sin(angle) * plane_[1]);
        }
        for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
            const auto i = static_cast<Index>(axis);
            frame_.increment[axis] = cluster_.axes.row(i).dot(turn) + cluster_.sigma(i) * normal_(random_) + wrong_by_[axis];
        }
        return monitor_->assess(frame_).isolated_mask;
    }

    const geometry::SensorCluster& cluster_;
    const Mission& mission_;
    std::mt19937_64& random_;
    Monitor monitor_;
    boost::random::normal_distribution<double> normal_;
    boost::random::uniform_real_distribution<double> direction_{0, 2 * std::numbers::pi};
    double phase_;
    std::array<Vector3d, 2> plane_;
    SensorFrame frame_{};
    std::array<double, max_axes> wrong_by_{};
    AxisMask failed_ = 0;   ///< with all that must be given up with it
    AxisMask missing_ = 0;
    std::size_t place_ = 0;
};

/// The time of the first failure, given that there is one within the mission.
double first_failure_h(double rate_per_h, double hours, std::mt19937_64& random)
{
    const double share = boost::random::uniform_real_distribution<double>(0, 1)(random);
    return -std::log1p(share * std::expm1(-rate_per_h * hours)) / rate_per_h;
}

std::size_t failing_part(const std::vector<Part>& parts, double rate_per_h, std::mt19937_64& random)
{
    double left = boost::random::uniform_real_distribution<double>(0, rate_per_h)(random);
    for (std::size_t index = 0; index + 1 < parts.size(); ++index)
        if ((left -= parts[index].failures_per_h) < 0) return index;
    return parts.size() - 1;
}

void play_mission(const geometry::SensorCluster& cluster, const Mission& mission, std::vector<Part> parts, std::mt19937_64& random, Tally& tally)
{
    ++tally.missions;
    Play play(cluster, mission, random);
    double rate = total_rate(parts);
    for (double time_h = first_failure_h(rate, mission.hours, random); time_h < mission.hours;
         time_h += boost::random::exponential_distribution<double>(rate)(random)) {
        const std::size_t index = failing_part(parts, rate, random);
        if (!play.survives(parts[index], tally)) return;
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(index));
        if (parts.empty()) break;
        rate = total_rate(parts);
    }
    ++tally.survived;
}

Tally play_block(const geometry::SensorCluster& cluster, const Mission& mission, const std::vector<Part>& parts, std::uint64_t seed,
                 std::size_t block)
{
    std::seed_seq sequence{seed, static_cast<std::uint64_t>(block)};
    std::mt19937_64 random(sequence);
    Tally tally;
    const std::uint64_t trials = std::min(trials_of_block, mission.trials - block * trials_of_block);
    for (std::uint64_t trial = 0; trial < trials; ++trial) play_mission(cluster, mission, parts, random, tally);
    return tally;
}

/// The trials say what becomes of missions with a failure; how many have none is exact.
Survival survival_of(const std::vector<Tally>& tallies, double without_failure)
{
    Tally sum;
    for (const Tally& tally : tallies) {
        sum.missions += tally.missions;
        sum.survived += tally.survived;
        for (std::size_t place = 0; place < tally.reached.size(); ++place) {
            if (sum.reached.size() <= place) {
                sum.reached.resize(place + 1, 0);
                sum.isolated.resize(place + 1, 0);
            }
            sum.reached[place] += tally.reached[place];
            sum.isolated[place] += tally.isolated[place];
        }
    }
    const auto count = static_cast<double>(sum.missions);
    const double share = static_cast<double>(sum.survived) / count;
    Survival survival{without_failure + (1 - without_failure) * share, (1 - without_failure) * std::sqrt(share * (1 - share) / count), {}};
    for (std::size_t place = 0; place < sum.reached.size(); ++place)
        survival.coverage.push_back(static_cast<double>(sum.isolated[place]) / static_cast<double>(sum.reached[place]));
    return survival;
}

}  // namespace

tl::expected<Survival, std::string> survival(const geometry::SensorCluster& cluster, const Mission& mission, std::uint64_t seed,
                                             const ForEach& for_each)
{
    geometry::SensorCluster array = cluster;
    array.interval_s = interval_s;
    if (array.sigma.minCoeff() <= 0) array.sigma.setOnes();
    if (array.size() > 3)
        if (const auto monitor = make_monitor(array, mission); !monitor) return tl::unexpected(monitor.error());
    const std::vector<Part> parts = parts_of(array, mission);
    const double without_failure = std::exp(-total_rate(parts) * mission.hours);
    if (parts.empty() || without_failure == 1) return Survival{1, 0, {}};

    const std::size_t blocks = (mission.trials + trials_of_block - 1) / trials_of_block;
    std::vector<Tally> tallies(blocks);
    for_each(blocks, [&](std::size_t block) { tallies[block] = play_block(array, mission, parts, seed, block); });
    return survival_of(tallies, without_failure);
}

}  // namespace quorient::design
