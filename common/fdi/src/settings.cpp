#include "quorient/fdi/settings.hpp"

#include <array>
#include <string>

namespace quorient::fdi {

namespace {

using settings::above_zero;
using settings::not_negative;
using settings::probability;

constexpr std::array<settings::Setting<DetectorSettings>, 13> detection{{
    {"tolerance", &DetectorSettings::tolerance, "", above_zero,
     "How much measurements of healthy axes may disagree, in the unit of one increment. For `invariants`, `voting`, `mean`, "
     "`extrapolation` "
     "and `vector`.",
     "from the noise"},
    {"sigma", &DetectorSettings::sigma, "", above_zero, "Standard deviation of one increment's noise, in its unit.",
     "as the description says"},
    {"pfa", &DetectorSettings::pfa, "", probability, "Probability of a false alarm in one frame.", "by the method"},
    {"bound", &DetectorSettings::bound, "", above_zero, "`guaranteed`: the noise of one increment never exceeds this, in its unit.",
     "from noise and `pfa`"},
    {"threshold", &DetectorSettings::threshold, "", above_zero, "`guaranteed`: what counts as a fault, in the unit of one increment.",
     "by the method"},
    {"max_faults", &DetectorSettings::max_faults, "", {.lowest = 1}, "Faults that may be present at once.", "by the method"},
    {"margin", &DetectorSettings::margin, "", not_negative,
     "`subset`, `glt`: the best explanation must be better than the next by this much.", "by the method"},
    {"doubt", &DetectorSettings::doubt, "", probability,
     "`subset`: share of right isolations that is held back because one more, small fault is not ruled out.", "by the method"},
    {"motion_noise", &DetectorSettings::motion_noise, "", above_zero,
     "`accumulating`: the errors of a moving array, as a multiple of what is usual.", "by the calibration; else 1"},
    {"delay_class_s", &DetectorSettings::delay_class_s, "s", above_zero,
     "`field`: standard deviation of the delays of sound instruments.", "0.1 intervals, 1 ms at least"},
    {"instruments", &DetectorSettings::instruments, "", {}, "A fault takes all axes of an instrument."},
    {"relaxed",
     &DetectorSettings::relaxed,
     "",
     {},
     "`invariants`: the smallest passing quadruple excludes its complement, even if the exact pattern is not there."},
    {"bare", &DetectorSettings::bare, "", {}, "`mean` and relaxed `invariants`: the rule of the paper as such, which does not look for rivals."},
}};

constexpr double longest_window = 32;  // frames of a window are bits of a word

constexpr std::array<settings::Setting<VerdictSettings>, 5> verdicts{{
    {"confirm_required",
     &VerdictSettings::confirm_required,
     "frames",
     {.lowest = 1, .highest = longest_window},
     "An axis is isolated when so many frames of `confirm_window` name it."},
    {"confirm_window",
     &VerdictSettings::confirm_window,
     "frames",
     {.lowest = 1, .highest = longest_window},
     "Newest frames that are looked at for it."},
    {"warm_up_frames",
     &VerdictSettings::warm_up_frames,
     "frames",
     {.lowest = 0, .highest = 100'000},
     "Nothing is isolated in the first frames of an epoch."},
    {"onset_guard_frames",
     &VerdictSettings::onset_guard_frames,
     "frames",
     {.lowest = 0, .highest = 1000},
     "The onset is placed this much earlier: a frame too late costs a contaminated increment, a frame too early costs little."},
    {"readmit_after_s", &VerdictSettings::readmit_after_s, "s", above_zero,
     "An isolated axis that agrees with the others for so long is trusted again.", "by `quorient readmit` only"},
}};

}  // namespace

settings::Record<DetectorSettings> detector_record()
{
    return detection;
}

settings::Record<VerdictSettings> verdict_record()
{
    return verdicts;
}

tl::expected<void, std::string> check(const VerdictSettings& settings)
{
    if (const auto bounded = settings::check(verdict_record(), settings); !bounded) return bounded;
    if (settings.confirm_required > settings.confirm_window)
        return tl::unexpected("confirm_required cannot be more than confirm_window, which is " + std::to_string(settings.confirm_window));
    return {};
}

}  // namespace quorient::fdi
