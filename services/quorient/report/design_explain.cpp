#include "design_explain.hpp"

#include "cli/json_output.hpp"
#include "design_report.hpp"
#include "quorient/design/mission.hpp"
#include "quorient/design/recognise.hpp"
#include "quorient/geometry/layouts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

namespace quorient::cli {

namespace {

using design::Figures;

constexpr double same = 5e-4;  // relative: less than can be seen in the table

/// What builders usually take.
struct CommonChoice {
    const char* layout;
    const char* words;
};
constexpr CommonChoice common_choices[] = {
    {"orthogonal-3-plus-1", "three at right angles plus one"},
    {"cone-4", "four on a cone"},
    {"triads-2", "two triads, aligned"},
    {"two-triads:1,1,1,60", "two triads, skewed by 60 deg"},
    {"dodecahedron", "six along a dodecahedron"},
};

/// An array in the table of comparisons.
struct Compared {
    std::string words;
    std::size_t axes = 0;
    Figures figures;
    std::string name;  ///< the layout that it is, turned; empty: none
};

/// rms error of the body vector, in the noise of one axis.
double error_after(const Figures& figures, unsigned failures)
{
    if (failures == 0) return std::sqrt(figures.trace);
    return failures <= figures.worst_after.size() ? std::sqrt(figures.worst_after[failures - 1].trace) : undefined;
}

std::string number(double value, int digits = 2)
{
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

unsigned failures_of(std::size_t axes)
{
    return static_cast<unsigned>(std::min<std::size_t>(2, axes - 3));
}

/// The first new instrument's noise: the common choices are built from such ones.
double noise_of(const design::Brief& brief)
{
    return brief.noise.empty() ? 1 : brief.noise.front();
}

Compared common(const CommonChoice& choice, const design::Brief& brief, std::uint64_t seed, const design::ForEach& for_each)
{
    const auto cluster = geometry::layout(choice.layout).value();
    auto yardstick = design::Yardstick::of(cluster, failures_of(cluster.size()));
    yardstick.noise *= noise_of(brief);
    Compared one{choice.words, cluster.size(), design::judge(cluster.axes, yardstick), design::same_as(cluster.axes)};
    if (!brief.mission) return one;
    design::Mission mission = *brief.mission;
    mission.shared.clear();  // they name instruments of the brief
    if (const auto played = design::survival(cluster, mission, seed, for_each)) one.figures.survival = *played;
    return one;
}

void append_compared(std::string& text, const Compared& one, bool mission)
{
    fmt::format_to(std::back_inserter(text), "  {:<32}{:>5}{:>9}{:>9}{:>9}{:>11}", one.words, one.axes, number(error_after(one.figures, 0)),
                   number(error_after(one.figures, 1)), number(error_after(one.figures, 2)), number(one.figures.fault.isolated_axis, 1));
    if (mission) text += fmt::format("{:>11}", one.figures.survival ? number(one.figures.survival->probability, 4) : "-");
    text += '\n';
}

/// Two digits, and no powers of ten.
std::string significant(double value)
{
    return value < 100 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

std::string percent(double ratio)
{
    return fmt::format("{:.0f} %", 100 * (ratio - 1));
}

/// What it costs and what it gains to build the winner and not the other, in a few words each.
struct Balance {
    std::vector<std::string> costs, gains;

    void count(bool gain, std::string words) { (gain ? gains : costs).push_back(std::move(words)); }
};

void weigh_errors(Balance& balance, const Compared& winner, const Compared& other)
{
    constexpr const char* when[] = {"the error", "the error after a failure", "the error after two"};
    for (unsigned k = 0; k < 3; ++k) {
        const double own = error_after(winner.figures, k), theirs = error_after(other.figures, k);
        if (std::isfinite(own) && !std::isfinite(theirs))
            balance.count(true, fmt::format("no measurement is left there after the worst {}", k == 1 ? "failure" : "two failures"));
        if (std::isinf(own) && std::isfinite(theirs))
            balance.count(false, fmt::format("a measurement is left there after any {}", k == 1 ? "failure" : "two failures"));
        if (!std::isfinite(own) || !std::isfinite(theirs) || std::abs(theirs / own - 1) < same) continue;
        if (theirs > own) balance.count(true, fmt::format("{} is {} larger there", when[k], percent(theirs / own)));
        else balance.count(false, fmt::format("{} is {} smaller there", when[k], percent(own / theirs)));
    }
}

void weigh_isolation(Balance& balance, const Compared& winner, const Compared& other)
{
    const double own = winner.figures.fault.isolated_axis, theirs = other.figures.fault.isolated_axis;
    if (std::isfinite(own) && !std::isfinite(theirs)) balance.count(true, "one sample there shows a fault without naming its axis");
    if (!std::isfinite(own) && std::isfinite(theirs)) balance.count(false, "one sample there names the axis of a fault");
    if (!winner.figures.survival || !other.figures.survival) return;
    const double lost = 1 - winner.figures.survival->probability, lost_there = 1 - other.figures.survival->probability;
    const double sure = 2 * std::hypot(winner.figures.survival->standard_error, other.figures.survival->standard_error);
    if (std::abs(lost - lost_there) > sure)
        balance.count(lost_there > lost,
                      fmt::format("{:.2g} % of the missions are lost there, {:.2g} % here", 100 * lost_there, 100 * lost));
}

std::string against(const Compared& winner, const Compared& other)
{
    std::string text = fmt::format("  Against {}:\n", other.words);
    if (!other.name.empty() && other.name == winner.name) return text + "    it is the winner.\n";
    Balance balance;
    if (winner.axes != other.axes) {
        const std::size_t more = winner.axes > other.axes ? winner.axes - other.axes : other.axes - winner.axes;
        balance.count(winner.axes < other.axes,
                      fmt::format("{} {} {}", more, more == 1 ? "axis" : "axes", winner.axes < other.axes ? "fewer" : "more"));
    }
    weigh_errors(balance, winner, other);
    weigh_isolation(balance, winner, other);
    if (!balance.costs.empty()) text += fmt::format("    costs  {}\n", fmt::join(balance.costs, "\n           "));
    if (!balance.gains.empty()) text += fmt::format("    gains  {}\n", fmt::join(balance.gains, "\n           "));
    if (balance.costs.empty() && balance.gains.empty()) text += "    no difference worth a word\n";
    return text;
}

/// What parity says of the first, second and third failure in the worst case: a failure shows if it may be missing, and is named if one more may.
std::string after_failures(const Figures& figures)
{
    constexpr const char* which[] = {"first", "second", "third"};
    std::string text;
    for (unsigned place = 0; place < 3; ++place) {
        const bool named = design::named_in_turn(figures) > place, shows = figures.detectable > place;
        text += fmt::format("  In the worst case parity {} the {} failure.\n",
                            named   ? "names"
                            : shows ? "shows and does not name"
                                    : "does not show",
                            which[place]);
    }
    return text;
}

void append_two_failures(std::string& text, const Figures& figures, std::size_t axes)
{
    text += "\nWHAT TWO FAILURES LEAVE\n";
    if (figures.worst_after.size() < 2) {
        text += fmt::format("  {} axes are not judged after two failures: fewer than 3 would be left, or they were not asked for.\n", axes);
        return;
    }
    const auto& after = figures.worst_after[1];
    if (!std::isfinite(after.trace)) {
        text += "  In the worst case no three directions: what is left lies in one plane.\n";
        return;
    }
    fmt::format_to(std::back_inserter(text),
                   "  In the worst case an rms error of {:.3g}, {:.2g} times that of the whole array, and a variance {:.2g} times as large\n"
                   "  in one direction as in another.\n",
                   std::sqrt(after.trace), std::sqrt(after.trace / figures.trace), after.condition);
    text += after_failures(figures);
    if (figures.isolable >= 2) text += "  Two failures in the same moment are isolated whatever their sizes.\n";
    else text += "  Two failures in the same moment may look like two others: the answer is then a list of candidates.\n";
}

void append_bounds(std::string& text, const Figures& figures, const design::Bounds& bounds)
{
    text += "\nHOW FAR FROM WHAT IS POSSIBLE AT ALL\n";
    const auto row = [&](const std::string& name, double own, double bound, bool more) {
        if (!std::isfinite(own) || !std::isfinite(bound)) return;
        const double missing = more ? bound / own - 1 : own / bound - 1;
        const std::string distance = !std::isfinite(missing) ? "nothing of a bound that may not be reachable"
                                                             : fmt::format("{} % from a bound that may not be reachable", significant(100 * missing));
        fmt::format_to(std::back_inserter(text), "  {:<36}{:>12.6f}{:>12.6f}   {}\n", name, own, bound,
                       missing < 1e-9 ? "met: no array does better" : distance);
    };
    row("trace with all axes", figures.trace, bounds.trace, false);
    for (std::size_t k = 0; k < std::min(figures.worst_after.size(), bounds.worst_after.size()); ++k)
        row(fmt::format("worst trace after {}", k + 1), figures.worst_after[k].trace, bounds.worst_after[k].trace, false);
    row("F_d1, detection of the worst axis", figures.f_d1, bounds.f_d1, true);
    row("F_d2, isolation of the worst axis", figures.f_d2, bounds.f_d2, true);
    row("smallest angle, deg", figures.minimum_angle_rad * 180 / std::numbers::pi, bounds.minimum_angle_rad * 180 / std::numbers::pi, true);
}

void append_winner(std::string& text, const design::Design& winner)
{
    text += "\nTHE WINNER\n";
    const auto name = design::same_as(winner.cluster.axes);
    if (!name.empty()) text += fmt::format("  It is the layout `{}`, turned.\n", name);
    if (winner.symmetry > 1) text += fmt::format("  It looks the same after a turn of {:g} deg about z.\n", 360.0 / winner.symmetry);
    for (std::size_t axis = 0; axis < winner.cluster.size(); ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        const auto part = [&](Eigen::Index column) {
            return std::round(winner.cluster.axes(i, column) * 1e6) / 1e6 + 0.0;
        };  // + 0.0: no negative zero
        fmt::format_to(std::back_inserter(text), "  axis {:>2}  ({:>10.6f}, {:>10.6f}, {:>10.6f})\n", axis, part(0), part(1), part(2));
    }
}

}  // namespace

std::string explained(const design::Brief& brief, const design::SearchResult& result, std::uint64_t seed, const design::ForEach& for_each)
{
    const design::Design& best = result.designs.front();
    const Compared winner{"the winner", best.cluster.size(), best.figures, design::same_as(best.cluster.axes)};
    std::vector<Compared> others;
    for (const CommonChoice& choice : common_choices) others.push_back(common(choice, brief, seed, for_each));

    const bool mission = brief.mission.has_value();
    std::string text = fmt::format(
        "WHICH ARRAY TO BUILD: {} axes\n\n"
        "WHAT WAS COMPARED\n"
        "  The result of {}: {} of them {} not beaten in everything by another.\n"
        "  \"error\" is that of the measured rotation vector (rms). With noise 1 on each axis, three at right angles have 1.73.\n"
        "  \"names\" is the size of a fault, in sigma of its axis, that one sample detects and whose axis it names in 99 of 100 cases, for\n"
        "  the worst axis, at one false alarm in a million samples.\n",
        winner.axes, how_searched(result), result.designs.size(), result.designs.size() == 1 ? "is" : "are");
    if (!brief.noise.empty()) text += fmt::format("  Noise is as given; the common choices have the first instrument's, {:g}.\n", noise_of(brief));
    if (mission)
        text += fmt::format(
            "  \"survives\" is the share of missions that end well. At each failure the detection method itself has to name the axis, from frames of\n"
            "  noise and the fault.\n  The mission: {}.\n",
            mission_text(*brief.mission));
    append_winner(text, best);
    text += fmt::format("\nTHE COMMON CHOICES\n  {:<32}{:>5}{:>9}{:>9}{:>9}{:>11}{}\n", "", "axes", "error", "after 1", "after 2", "names",
                        mission ? "   survives" : "");
    append_compared(text, winner, mission);
    for (const Compared& other : others) append_compared(text, other, mission);
    text += '\n';
    for (const Compared& other : others) text += against(winner, other);
    append_two_failures(text, winner.figures, winner.axes);
    append_bounds(text, winner.figures, result.bounds);
    return text;
}

}  // namespace quorient::cli
