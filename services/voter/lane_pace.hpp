#pragma once

#include "quorient/runtime/pace.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quorient::voter {

/// Whether most lanes leave frames out because they are overloaded: then a voter compares them in the frames that all of them keep. One lane
/// alone does not slow the output down.
class LanePace {
public:
    explicit LanePace(std::size_t lanes) : lanes_(lanes) {}

    void see(std::size_t lane, Identity identity, std::int64_t now_ns)
    {
        lanes_[lane].pace.see(identity);
        lanes_[lane].seen_ns = now_ns;
    }

    bool most_shed(std::int64_t now_ns) const
    {
        const auto shed = std::ranges::count_if(lanes_, [now_ns](const Lane& lane) {
            return lane.pace.is_shed() && now_ns - lane.seen_ns < forgotten_ns;
        });
        return 2 * static_cast<std::size_t>(shed) > lanes_.size();
    }

private:
    /// A lane that gives out nothing any more sheds nothing.
    static constexpr std::int64_t forgotten_ns = 500'000'000;

    struct Lane {
        runtime::Pace pace;
        std::int64_t seen_ns = 0;
    };

    std::vector<Lane> lanes_;
};

}  // namespace quorient::voter
