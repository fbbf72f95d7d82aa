#include "quorient/voting/voter_settings.hpp"

#include "quorient/messages/limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace quorient::voting {
namespace {

std::string refuse(const char* setting, const char* rule, double value)
{
    return std::string(setting) + " must be " + rule + ", got " + std::to_string(value);
}

bool repeats(std::vector<std::uint32_t> ids)
{
    std::sort(ids.begin(), ids.end());
    return std::adjacent_find(ids.begin(), ids.end()) != ids.end();
}

}  // namespace

tl::expected<void, std::string> check(const VoterSettings& settings)
{
    const std::size_t lanes = settings.lanes.size();
    if (lanes == 0 || lanes > max_lanes) {
        return tl::unexpected("a voter needs 1 to " + std::to_string(max_lanes) + " lanes, got " + std::to_string(lanes));
    }
    std::vector<std::uint32_t> lane_ids, detector_ids;
    for (const auto& lane : settings.lanes) {
        lane_ids.push_back(lane.lane);
        detector_ids.push_back(lane.detector);
    }
    if (repeats(lane_ids)) return tl::unexpected(std::string("two lanes have the same id"));
    if (repeats(detector_ids)) return tl::unexpected(std::string("two lanes have the same detector"));
    if (repeats(settings.voters)) return tl::unexpected(std::string("two voters have the same id"));
    if (!settings.voters.empty() && std::find(settings.voters.begin(), settings.voters.end(), settings.voter) == settings.voters.end()) {
        return tl::unexpected("voter " + std::to_string(settings.voter) + " is not in the list of voters");
    }
    const std::array<std::pair<const char*, double>, 6> positive{{{"interval_s", settings.interval_s},
                                                                  {"patience", settings.patience},
                                                                  {"silence_intervals", settings.silence_intervals},
                                                                  {"coasting_to_lost_s", settings.coasting_to_lost_s},
                                                                  {"coasting_interval_s", settings.coasting_interval_s},
                                                                  {"lease_s", settings.lease_s}}};
    for (const auto& [name, value] : positive) {
        if (!(value > 0) || !std::isfinite(value)) return tl::unexpected(refuse(name, "above 0", value));
    }
    const std::array<std::pair<const char*, double>, 3> not_negative{{{"agreement_rad", settings.agreement_rad},
                                                                      {"agreement_sigmas", settings.agreement_sigmas},
                                                                      {"coasting_rate_rad_s", settings.coasting_rate_rad_s}}};
    for (const auto& [name, value] : not_negative) {
        if (!(value >= 0) || !std::isfinite(value)) return tl::unexpected(refuse(name, "0 or more", value));
    }
    if (settings.level_window == 0 || settings.level_window > 32) {
        return tl::unexpected(refuse("level_window", "1 to 32", settings.level_window));
    }
    if (settings.disagreement_frames == 0) return tl::unexpected(refuse("disagreement_frames", "above 0", 0));
    return {};
}

}  // namespace quorient::voting
