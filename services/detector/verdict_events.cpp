#include "verdict_events.hpp"

#include "quorient/messages/diagnosis_text.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>

namespace quorient::detector {
namespace {

AxisMask all_candidates(const FaultVerdict& verdict)
{
    const auto end = verdict.candidate_set.begin() + std::min<std::ptrdiff_t>(verdict.candidate_count, std::ssize(verdict.candidate_set));
    return std::accumulate(verdict.candidate_set.begin(), end, AxisMask{0}, std::bit_or<>{});
}

/// Each method has a unit of its own, in which its statistic means little to an operator; times the limit says how clear the case is.
std::string statistic_text(const FaultVerdict& verdict)
{
    if (!(verdict.threshold > 0)) return fmt::format("statistic {:.3g}", verdict.statistic);
    return fmt::format("statistic {:.3g} times its limit", verdict.statistic / verdict.threshold);
}

std::string suspect_text(const FaultVerdict& verdict, const ClusterDescription& description)
{
    if (verdict.suspect_mask != 0) return axis_names(description, verdict.suspect_mask);
    const AxisMask candidates = all_candidates(verdict);
    return candidates == 0 ? "no axis yet" : fmt::format("one of {}", axis_names(description, candidates));
}

/// Why these axes are isolated. Of those that another detector has isolated this one has no statistic.
std::string reason_of(const FaultVerdict& verdict, const ClusterDescription& description, AxisMask isolated, const FaultDiagnosis& diagnosis)
{
    const std::string kinds = diagnoses_text(diagnosis, description, isolated);
    if (verdict.adopted) return kinds.empty() ? "another detector has isolated it" : fmt::format("another detector has isolated it; {}", kinds);
    return fmt::format("{}; {}", kinds.empty() ? "disagrees with the others" : kinds, statistic_text(verdict));
}

}  // namespace

void VerdictEvents::report_changes(const FaultVerdict& verdict, const ClusterDescription& description, std::string_view reason,
                                   const FaultDiagnosis& diagnosis)
{
    report_isolations(verdict, description, diagnosis);
    report_provisional(verdict, description);
    const bool newly_isolated = (verdict.isolated_mask & ~last_.isolated_mask) != 0;
    if (verdict.state != last_.state && !newly_isolated) report_state(verdict, description, reason);
    last_ = verdict;
}

void VerdictEvents::report_isolations(const FaultVerdict& verdict, const ClusterDescription& description, const FaultDiagnosis& diagnosis)
{
    const auto identity = identity_of(verdict);
    const AxisMask isolated = verdict.isolated_mask & ~last_.isolated_mask;
    if (isolated != 0) {
        node_.report(verdict.adopted ? EventCode::adopted : EventCode::isolated, Severity::warning_high, identity, isolated,
                     fmt::format("{} {} since frame {}: {}", verdict.adopted ? "ADOPTED" : "ISOLATED", axis_names(description, isolated),
                                 verdict.excluded_from.earliest(isolated), reason_of(verdict, description, isolated, diagnosis)));
        if (verdict.detectable_remaining == 0)
            node_.report(EventCode::redundancy_exhausted, Severity::warning_high, identity, verdict.working_mask,
                         "redundancy is used up: no further fault can be detected");
    }
    const AxisMask readmitted = last_.isolated_mask & ~verdict.isolated_mask;
    if (readmitted != 0)
        node_.report(EventCode::readmitted, Severity::info, identity, readmitted,
                     fmt::format("READMITTED {}", axis_names(description, readmitted)));
}

/// An axis may come and go, so these are throttled.
void VerdictEvents::report_provisional(const FaultVerdict& verdict, const ClusterDescription& description)
{
    const AxisMask left_out = provisional_mask(verdict) & ~last_.excluded_from.mask();
    if (left_out != 0)
        node_.report_throttled(EventCode::left_out, Severity::warning_low, identity_of(verdict), left_out,
                               fmt::format("LEFT OUT {} since frame {}, until it is confirmed or agrees again",
                                           axis_names(description, left_out), verdict.excluded_from.earliest(left_out)));
    const AxisMask returned = provisional_mask(last_) & ~verdict.excluded_from.mask();
    if (returned != 0)
        node_.report_throttled(EventCode::returned, Severity::info, identity_of(verdict), returned,
                               fmt::format("RETURNED {}: it agrees with the others again", axis_names(description, returned)));
}

void VerdictEvents::report_state(const FaultVerdict& verdict, const ClusterDescription& description, std::string_view reason)
{
    const auto report = [&](EventCode code, Severity severity, AxisMask axes, const std::string& text) {
        node_.report_throttled(code, severity, identity_of(verdict), axes, text);
    };
    switch (state_of(verdict)) {
        case VerdictState::ambiguous:
            report(EventCode::ambiguous, Severity::warning_high, verdict.suspect_mask,
                   fmt::format("AMBIGUOUS: {} candidate sets, one of {} is faulty", verdict.candidate_count,
                               axis_names(description, all_candidates(verdict))));
            break;
        case VerdictState::blind:
            report(EventCode::blind, Severity::warning_high, 0,
                   fmt::format("BLIND: {}", reason.empty() ? "no set of faults within reach explains the data" : reason));
            break;
        case VerdictState::saturated:
            report(EventCode::saturated, Severity::warning_high, 0,
                   fmt::format("SATURATED: {}", reason.empty() ? "all instruments are at their limits, the rate is not known" : reason));
            break;
        case VerdictState::suspect:
            report(EventCode::suspect, Severity::warning_low, verdict.suspect_mask,
                   !reason.empty() ? fmt::format("SUSPECT: {}", reason)
                                   : fmt::format("SUSPECT {}: {}", suspect_text(verdict, description), statistic_text(verdict)));
            break;
        case VerdictState::warming_up:
            if (!reason.empty()) report(EventCode::blind, Severity::info, 0, fmt::format("WARMING_UP: {}", reason));
            break;
        default:
            break;
    }
}

}  // namespace quorient::detector
