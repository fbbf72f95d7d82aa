#include "quorient/voting/voter_settings.hpp"

#include "quorient/messages/limits.hpp"

#include <algorithm>
#include <array>

namespace quorient::voting {
namespace {

using settings::above_zero;
using settings::not_negative;
using Setting = settings::Setting<VoterSettings>;

constexpr double longest_level_window = 32;  // votes of a lane are bits of a word

constexpr std::array<Setting, 14> record{{
    {"patience",
     &VoterSettings::patience,
     "intervals",
     {.lowest = 0, .highest = 10, .lowest_included = false},
     "How long a frame waits for the votes of all lanes."},
    {"agreement_rad", &VoterSettings::agreement_rad, "rad", above_zero,
     "Two lanes agree within this angle plus `agreement_sigmas` standard deviations."},
    {"agreement_sigmas", &VoterSettings::agreement_sigmas, "", not_negative,
     "Standard deviations of the difference of two lanes that count as agreement."},
    {"disagreement_frames",
     &VoterSettings::disagreement_frames,
     "frames",
     {.lowest = 1},
     "A lane that a majority contradicts in so many consecutive frames is excluded."},
    {"settle_frames", &VoterSettings::settle_frames, "frames", not_negative,
     "After a suspicion, disagreement excludes no lane for so long."},
    {"silence_intervals",
     &VoterSettings::silence_intervals,
     "intervals",
     {.lowest = 1},
     "A lane, or the whole unit, counts as silent after this time without a frame."},
    {"coasting_to_lost_s", &VoterSettings::coasting_to_lost_s, "s", above_zero,
     "Without frames, the voted attitude becomes LOST after this time."},
    {"coasting_interval_s", &VoterSettings::coasting_interval_s, "s", above_zero,
     "Without frames, the last attitude is repeated at this interval."},
    {"coasting_rate_rad_s", &VoterSettings::coasting_rate_rad_s, "rad/s", not_negative,
     "Rotation beyond the last known rate that the standard deviation of a coasting attitude allows for."},
    {"return_frames",
     &VoterSettings::return_frames,
     "frames",
     {.lowest = 1},
     "An excluded lane counts again after so many consecutive frames in agreement."},
    {"lease_s",
     &VoterSettings::lease_s,
     "s",
     {.lowest = 0.01},
     "Lease of the right to write `voted`: another voter takes over after this time of silence.",
     "0.05, or 3 intervals if that is longer"},
    {"listen_s", &VoterSettings::listen_s, "s", not_negative,
     "A voter that starts in the middle of a stream waits so long for other voters."},
    {"level_window",
     &VoterSettings::level_window,
     "frames",
     {.lowest = 1, .highest = longest_level_window},
     "The level (FULL, DEGRADED, …) is judged from the votes of so many frames."},
    {"good_frames_before_owning",
     &VoterSettings::good_frames_before_owning,
     "frames",
     {.lowest = 0, .highest = 10'000},
     "A voter writes `voted` only after so many consecutive frames that a majority backs."},
}};

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
    if (!above_zero.hold(settings.interval_s))
        return tl::unexpected(settings::out_of_bounds("interval_s", above_zero, "s", settings.interval_s));
    return settings::check(voter_record(), settings);
}

settings::Record<VoterSettings> voter_record()
{
    return record;
}

}  // namespace quorient::voting
