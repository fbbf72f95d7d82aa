#pragma once

#include "quorient/runtime/pace.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quorient::voter {

/// Whether at least half of the lanes that publish leave frames out because they are overloaded: then a voter compares them in the frames that all
/// of them keep. Fewer lanes do not slow the output down: what they still give out is not taken, so they count as silent.
class LanePace {
public:
    explicit LanePace(std::size_t lanes) : lanes_(lanes) {}

    void see(std::size_t lane, Identity identity, std::int64_t now_ns)
    {
        lanes_[lane].pace.see(identity);
        lanes_[lane].seen_ns = now_ns;
    }

    bool sheds(std::size_t lane) const { return lanes_[lane].pace.is_shed(); }

    bool many_shed(std::int64_t now_ns) const
    {
        std::size_t speaking = 0;
        std::size_t shedding = 0;
        for (const Lane& lane : lanes_) {
            if (now_ns - lane.seen_ns >= forgotten_ns) continue;
            ++speaking;
            if (lane.pace.is_shed()) ++shedding;
        }
        return shedding > 0 && 2 * shedding >= speaking;
    }

private:
    /// A lane that gives out nothing any more does not count.
    static constexpr std::int64_t forgotten_ns = 500'000'000;

    struct Lane {
        runtime::Pace pace;
        std::int64_t seen_ns = 0;
    };

    std::vector<Lane> lanes_;
};

}  // namespace quorient::voter
