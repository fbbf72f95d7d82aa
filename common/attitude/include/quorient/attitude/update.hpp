#pragma once

#include "quorient/rotation/quaternion.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::attitude {

using namespace rotation;  // quaternions are this room's numbers

/// What the body turned in one interval: the integral of the body rate [rad], not a rotation vector.
struct Sample {
    Eigen::Vector3d increment = Eigen::Vector3d::Zero();
    double interval_s = 0;
};

/// attitude now = attitude `span` samples ago  o  rotation.
struct Step {
    std::size_t span = 1;
    Quaternion rotation = Quaternion::Identity();
};

/// Most samples that an algorithm may look back at. Beyond 12 a polynomial fit through increments loses more digits than it gains.
inline constexpr std::size_t longest_memory = 12;

/// An algorithm that turns body increments into attitude. It keeps no state: what it says of a sample depends only on the
/// samples it looks back at and on their place since the start, so going back in time is asking again.
class Update {
public:
    virtual ~Update() = default;

    /// How many samples it looks back at, the newest included; at most longest_memory.
    virtual std::size_t memory() const = 0;

    /// The attitude at the end of the newest sample.
    /// @param count   samples since the start, the newest included (1 = the first)
    /// @param recent  the newest min(count, memory()) samples, oldest first; finite, intervals above 0, increments below 1e6 rad
    virtual Step step(std::uint64_t count, std::span<const Sample> recent) const = 0;
};

/// False where a new start is better than going on: after an interval more than four times as long as the next one the long
/// sample says too little about the short ones. (A long sample after short ones is taken, with a lower order.)
bool same_start(double earlier_interval_s, double interval_s);

struct UpdateEntry {
    std::string name;
    std::string equation;
    std::string source;
};

/// All algorithms by name, with equation and source.
std::vector<UpdateEntry> update_catalogue();

/// @param name  single, previous, two-sample, three-sample, three-sample-miller, four-sample, block-N or window-N (N = 1 .. 12)
/// @returns an error that lists the names.
tl::expected<std::unique_ptr<const Update>, std::string> make_update(std::string_view name);

}  // namespace quorient::attitude
