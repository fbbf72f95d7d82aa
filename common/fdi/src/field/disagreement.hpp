#pragma once

#include "quorient/fdi/detector.hpp"

#include <algorithm>

namespace quorient::fdi::field {

/// A contradiction that several members of a comparison explain alike. Times are counts of compared frames.
class Disagreement {
public:
    /// For so many frames from now on.
    /// @param onset  sequence; counts where no disagreement lasted until now
    void renew(std::uint64_t onset, std::uint64_t frames, std::uint64_t now)
    {
        if (now > until_) onset_ = onset;
        until_ = std::max(until_, now + frames);
    }

    bool lasts(std::uint64_t now) const { return now > 0 && now <= until_; }
    std::uint64_t onset() const { return onset_; }
    void reset() { until_ = 0; }

private:
    std::uint64_t until_ = 0;
    std::uint64_t onset_ = never;
};

}  // namespace quorient::fdi::field
