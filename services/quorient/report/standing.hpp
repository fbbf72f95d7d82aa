#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace quorient::report {

/// What the services of one unit sent last: enough to say in one line whether its attitude is good.
struct Standing {
    std::optional<ClusterDescription> description;
    std::optional<VotedAttitude> voted;             ///< from whoever owns the output; absent where no voter owns it
    bool output_is_due = true;                      ///< voters have been received for so long that the absence of `voted` means something
    std::map<std::uint32_t, FaultVerdict> verdicts;  ///< by detector, whose number is also that of its lane
    std::map<std::uint32_t, std::string> voters;    ///< names by number
    std::map<std::uint32_t, std::string> lanes;     ///< likewise
    std::optional<std::int64_t> level_since_ns;     ///< wall time of the newest change of the level
};

/// "GOOD: attitude FULL since 25 s, from voter-1, primary lane a, 3 lanes vouch; out: G2 since 8.4 s; 3 axes left, no further fault can be
/// detected". A unit without voters is judged by its verdicts.
/// @param now_ns  wall time
std::string standing_text(const Standing& standing, std::int64_t now_ns);

/// The same for machines.
nlohmann::ordered_json standing_json(const Standing& standing, std::int64_t now_ns);

}  // namespace quorient::report
