#pragma once

#include "field/windows.hpp"

#include <optional>

namespace quorient::fdi::field {

/// A contradiction between one instrument, or one axis where single axes are compared, and the others.
struct Suspicion {
    double certainty = 0;  ///< C; above 1 it is more than noise and allowances explain
    std::size_t instrument = 0;
    std::size_t component = 0;
    std::size_t window = 0;  ///< frames up to the newest one
    Filter filter = Filter::bias;
};

/// What all windows of one frame say.
struct Suspicions {
    Suspicion brief;                            ///< the largest that may only be passing
    Suspicion lasting;                          ///< the largest of a lasting window that persists
    std::array<double, max_members> brief_of{};  ///< the largest against each instrument
    std::array<double, max_members> lasting_of{};
    double disturbance = 0;                     ///< the largest of a long window, before its low-passed twin agreed
    double closest = 0;                         ///< the largest of a long window that lasts, looked for from 0.4 on

    /// Takes in what one window says of one instrument.
    /// @param lasting  the window is long enough
    /// @param persists, may_pass  asked only where they decide: the contradiction is there in all the window; it could matter to the attitude
    template <class Persists, class MayPass>
    void take(const Suspicion& found, bool is_lasting, Persists persists, MayPass may_pass)
    {
        const std::size_t m = found.instrument;
        const double certain = found.certainty;
        const bool lasts = is_lasting && certain > std::max(Windows::watched_from, std::min(1.0, closest)) && persists();
        if (lasts) closest = std::max(closest, certain);
        if (is_lasting && (certain <= 1 || lasts)) {
            lasting_of[m] = std::max(lasting_of[m], certain);
            disturbance = std::max(disturbance, certain);
            if (certain > lasting.certainty) lasting = found;
            return;
        }
        if (!may_pass()) return;
        brief_of[m] = std::max(brief_of[m], certain);
        if (certain > brief.certainty) brief = found;
    }

    const Suspicion& largest() const { return lasting.certainty > brief.certainty ? lasting : brief; }

    /// The contradiction of any window that no other instrument explains nearly as well: it leaves an instrument out.
    std::optional<Suspicion> contradicted() const;

    /// Likewise one that lasts: it names the instrument.
    std::optional<Suspicion> proved() const;
};

}  // namespace quorient::fdi::field
