#include "quorient/runtime/shedding.hpp"

#include "quorient/messages/codes.hpp"

#include <fmt/format.h>

namespace quorient::runtime {

namespace {

/// A queue holds fewer frames. Whoever is further behind the newest one shows that that one was wrong.
constexpr std::uint64_t longest_queue = 1000;

}  // namespace

/// @returns false for a frame that is not newer
bool Shedding::Stream::see(Identity identity, const Stamps& stamps, std::int64_t now_ns)
{
    const bool far_behind = identity.epoch == newest.epoch && newest.sequence > identity.sequence + longest_queue;
    if (identity <= newest && !far_behind) return false;
    newest = identity;
    const std::int64_t stamp_ns = stamps[static_cast<std::size_t>(Hop::sensor)];
    age_ns = age.see(identity.epoch, stamp_ns, now_ns);
    overload->on_sample(age_ns, stamp_ns, now_ns);
    return true;
}

void Shedding::see(Identity identity, const Stamps& stamps, double interval_s, std::int64_t now_ns)
{
    if (!input_.overload) {
        input_.overload.emplace(interval_s);
        voted_.overload.emplace(interval_s);
    }
    if (input_.see(identity, stamps, now_ns)) report(input_, now_ns);
}

void Shedding::see_voted(Identity identity, const Stamps& stamps, std::int64_t now_ns)
{
    const bool of_input = identity.epoch == input_.newest.epoch && identity <= input_.newest;
    if (!voted_.overload || !of_input || !voted_.see(identity, stamps, now_ns)) return;
    pace_of_voted_.see(identity);
    if (pace_of_voted_.is_shed()) voted_.overload->on_others_shed(now_ns);
    report(voted_, now_ns);
}

void Shedding::report(const Stream& seen, std::int64_t now_ns)
{
    if (!reported_ && seen.sheds()) {
        reported_ = true;
        begin_ns_ = now_ns;
        skipped_before_ = skipped_;
        const std::string why = &seen == &input_ ? fmt::format("frames are {:.0f} ms old", static_cast<double>(seen.age_ns) * 1e-6)
                                : pace_of_voted_.is_shed()
                                    ? "the voters leave frames out"
                                    : fmt::format("voted attitudes are {:.0f} ms old", static_cast<double>(seen.age_ns) * 1e-6);
        node_.report(
            EventCode::overloaded, Severity::warning_high, seen.newest, 0,
            fmt::format("OVERLOADED: {}. One in {} of this service's {} goes out at most. Lower the rate, compose, or add processors", why,
                        Pace::kept_of, outputs_));
    } else if (reported_ && input_.keeps_up() && voted_.keeps_up()) {
        reported_ = false;
        node_.report(EventCode::overloaded, Severity::info, seen.newest, 0,
                     fmt::format("keeps up again: {} {} were left out in {:.0f} s", skipped_ - skipped_before_, outputs_,
                                 static_cast<double>(now_ns - begin_ns_) * 1e-9));
    }
}

}  // namespace quorient::runtime
