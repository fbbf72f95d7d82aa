#pragma once

#include "quorient/fdi/sensor_class.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace quorient::studies {

/// How the faults of one trial are drawn: on axes chosen uniformly without repetition, each sign as likely as the other.
struct Faults {
    enum class Law : std::uint8_t {
        uniform,     ///< size U(least, most)
        cut_normal,  ///< size |N(0, 1)|, given that it is at least `least`
    };

    std::size_t count = 0;
    double least = 0;  ///< in sigma (noisy scenes), else in the unit of the law
    double most = 0;
    Law law = Law::uniform;
    bool equal = false;  ///< all faults of a trial have one size; signs still vary
};

/// What a judge says about one measurement.
struct Answer {
    bool decided = false;  ///< false: flagged (ambiguous, suspect, refused, blind)
    AxisMask named = 0;    ///< where decided; 0 = healthy
};

/// One way of deciding. One thread uses it; answering allocates nothing.
class Judge {
public:
    virtual ~Judge() = default;
    virtual Answer answer(std::span<const double> measurement) = 0;
};

using JudgeFactory = std::function<std::unique_ptr<Judge>(const geometry::SensorCluster&, const Faults&)>;

/// Trials of one kind. All judges of a scene see the same measurements.
struct Scene {
    geometry::SensorCluster cluster;
    Faults faults;
    bool noisy = true;  ///< N(0, 1) on every axis, else none
    std::vector<JudgeFactory> judges;
};

/// What became of the trials of one judge in one scene.
struct Tally {
    std::uint64_t correct = 0;  ///< the faulty axes named, no other; healthy where there is no fault
    std::uint64_t wrong = 0;    ///< another set named, without a flag
    std::uint64_t missed = 0;   ///< healthy, with a fault
    std::uint64_t flagged = 0;

    void count(const Answer& answer, AxisMask faulty);
    Tally& operator+=(const Tally& other);
    std::uint64_t trials() const { return correct + wrong + missed + flagged; }
    bool operator==(const Tally&) const = default;
};

/// A share in percent, and its Monte-Carlo standard error.
struct Rate {
    double percent = 0;
    double error = 0;
};
Rate rate(std::uint64_t count, std::uint64_t trials);

struct RunSettings {
    std::uint64_t trials = 0;  ///< per scene
    std::uint64_t seed = 1;
    unsigned threads = 0;                       ///< 0 = one per core
    std::vector<std::filesystem::path> logs{};  ///< recordings, for the studies that play some
    std::vector<std::filesystem::path> faulty_logs{};  ///< study field: with a real fault
    fdi::Mount mount = fdi::Mount::board;              ///< study field
};

/// Called after each block with the blocks done and their number; from any thread, one call at a time.
using OnProgress = std::function<void(std::size_t, std::size_t)>;

/// Plays every scene. Trials come in blocks of block_trials whose random numbers are a function of (seed, scene, block) alone, and
/// counts are sums of integers: the result depends on neither the number of threads nor their order.
/// @returns one tally per scene and judge.
std::vector<std::vector<Tally>> run(const std::vector<Scene>& scenes, const RunSettings& settings, const OnProgress& on_progress = {});

inline constexpr std::uint64_t block_trials = 1000;

}  // namespace quorient::studies
