#pragma once

#include "quorient/messages/time.hpp"
#include "quorient/voting/voter_settings.hpp"

#include <algorithm>
#include <cstdint>

namespace quorient::voting {

/// The lengths of time among the settings, in whole nanoseconds.
struct Durations {
    explicit Durations(const VoterSettings& settings)
        : interval_ns(std::max<std::int64_t>(1, nanoseconds(settings.interval_s))),
          patience_ns(nanoseconds(settings.interval_s * settings.patience)),
          silence_ns(nanoseconds(settings.interval_s * settings.silence_intervals)),
          lease_ns(nanoseconds(settings.lease_s)),
          listen_ns(nanoseconds(settings.listen_s)),
          coasting_interval_ns(nanoseconds(settings.coasting_interval_s)),
          coasting_to_lost_ns(nanoseconds(settings.coasting_to_lost_s))
    {
    }

    /// Where one in so many frames comes. A leading voter must publish within its lease, so silence ends before that.
    Durations at_pace(unsigned one_in) const
    {
        Durations paced = *this;
        paced.patience_ns *= one_in;
        paced.silence_ns = std::max(silence_ns, std::min(silence_ns * one_in, lease_ns * 4 / 5));
        return paced;
    }

    std::int64_t interval_ns;
    std::int64_t patience_ns;
    std::int64_t silence_ns;
    std::int64_t lease_ns;
    std::int64_t listen_ns;
    std::int64_t coasting_interval_ns;
    std::int64_t coasting_to_lost_ns;
};

}  // namespace quorient::voting
