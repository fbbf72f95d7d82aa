#pragma once

#include "history.hpp"
#include "quorient/system/system.hpp"
#include "tick.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace quorient::monitor {

/// What never changes while the monitor runs.
struct Names {
    explicit Names(const system::System& system);

    std::string system;
    std::uint32_t unit = 0;
    std::vector<std::string> lanes;
    std::vector<std::uint32_t> lane_ids;
    bool has_attitude = true;
    bool orders = false;
    bool token = false;  ///< other hosts may send orders too, with a token
};

/// Shortest text of a number with this many significant digits; null for what is not finite.
nlohmann::json rounded(double value, int digits = 5);

/// As text; bytes that are no UTF-8 (a peer's text) are replaced.
std::string dumped(const nlohmann::json& value);

/// The whole state of a system at one moment. Its members: README.md.
nlohmann::json picture(const Tick& tick, const Names& names);

/// An event as the page lists it.
nlohmann::json event_json(const HealthEvent& event);

/// One sample of the plots: the tick's own, or a second's.
nlohmann::json sample_json(const Sample& sample);

/// What a picture says in words of the level: FULL … LOST, or NO OUTPUT where no voted attitude is fresh.
std::string_view level_word(const Tick& tick);

/// "primary", "vouches", or why the lane is left out.
std::string_view standing(const Tick& tick, const Names& names, std::size_t place);

}  // namespace quorient::monitor
