#include "report/diagnosis_text.hpp"

#include "quorient/diagnosis/words.hpp"
#include "quorient/messages/units.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <cmath>
#include <optional>

namespace quorient::cli {
namespace {

using diagnosis::counted;
using diagnosis::InstrumentFacts;
using diagnosis::Report;

std::string three(const std::optional<Eigen::Vector3d>& values, int digits)
{
    if (!values) return "-";
    std::string text;
    for (const double value : *values) {
        text += text.empty() ? "" : " ";
        text += std::isfinite(value) ? diagnosis::fixed(value, digits) : "-";
    }
    return text;
}

std::string turn_of(const InstrumentFacts& facts)
{
    if (!facts.rotation) return "-";
    const Eigen::AngleAxisd turn(*facts.rotation);
    const double angle_deg = turn.angle() / degree;
    if (angle_deg < 0.05) return "by 0 degrees";
    return fmt::format("by {:.1f} degrees about ({:.2f} {:.2f} {:.2f})", angle_deg, turn.axis().x(), turn.axis().y(), turn.axis().z());
}

void add_troubles(const InstrumentFacts& facts, std::string& text)
{
    const recording::InstrumentFigures& figures = facts.figures;
    const auto add = [&](std::uint64_t count, std::string_view what) {
        if (count > 0) text += fmt::format(", {} {}", count, what);
    };
    if (figures.gaps > 0) text += fmt::format(", {} (longest {:.3f} s)", counted(figures.gaps, "gap"), figures.longest_gap_s);
    if (const auto lost = figures.lost + facts.clock.lost; lost > 0) text += fmt::format(", {} lost", counted(lost, "sample"));
    if (figures.duplicates > 0) text += ", " + counted(figures.duplicates, "duplicate");
    if (figures.steps_back > 0) text += fmt::format(", {} back in time", counted(figures.steps_back, "step"));
    add(figures.not_finite, "without a value");
    const auto& clipped = figures.clipping_logged ? figures.clipped : figures.at_extreme;
    add(clipped[0] + clipped[1] + clipped[2], figures.clipping_logged ? "clipped" : "at the largest value");
}

/// Sensors without a thermometer report 0 all the time.
std::string temperature_of(const recording::InstrumentFigures& figures)
{
    const double least = figures.temperature_min_c;
    const double most = figures.temperature_max_c;
    if (!std::isfinite(least) || (least == 0 && most == 0)) return {};
    if (std::round(least) == std::round(most)) return fmt::format(", {:.0f} degrees C", least);
    return fmt::format(", {:.0f} to {:.0f} degrees C", least, most);
}

std::string instrument_text(const InstrumentFacts& facts)
{
    const recording::InstrumentFigures& figures = facts.figures;
    std::string text = fmt::format("  {}: {:.2f} Hz, jitter {:.2f} ms, coverage {:.1f} %", facts.name, figures.rate_hz(), figures.jitter_s * 1e3,
                                   100 * figures.coverage);
    add_troubles(facts, text);
    if (facts.clock.tied) text += fmt::format(", clock {:+.2f} ms", facts.clock.offset_s * 1e3);
    if (facts.clock.own_clock) text += fmt::format(", stamps late by up to {:.0f} ms", facts.clock.late_most_s * 1e3);
    text += temperature_of(figures) + '\n';
    if (!facts.compared) return text + "      not compared\n";
    std::string known;
    const auto add = [&](bool is_known, const std::string& what) {
        if (is_known) known += (known.empty() ? "      " : ", ") + what;
    };
    const auto next_line = [&] { text += known.empty() ? "" : known + '\n', known.clear(); };
    add(facts.bias_deg_s.has_value(),
        fmt::format("bias {} deg/s ({})", three(facts.bias_deg_s, 2), facts.bias_from_rest ? "at rest" : "against the others"));
    add(facts.gain.has_value(), fmt::format("gain {}", three(facts.gain, 3)));
    add(facts.rotation.has_value(), fmt::format("turned {}", turn_of(facts)));
    next_line();
    add(facts.noise_rest_deg_s.has_value(), fmt::format("noise {} deg/s at rest", three(facts.noise_rest_deg_s, 3)));
    add(facts.noise_motion_deg_s.has_value(), fmt::format("noise {} deg/s against the others in motion", three(facts.noise_motion_deg_s, 2)));
    next_line();
    return text;
}

std::string holes_of(const Report& report)
{
    std::string text;
    for (const diagnosis::Hole& hole : report.holes)
        text += fmt::format("{}{:.2f} to {:.2f} s", text.empty() ? " and nothing from " : ", ", hole.from_s, hole.to_s);
    return text;
}

}  // namespace

std::string diagnosis_text(const Report& report)
{
    std::string text = report.sentence + "\n\n";
    text += fmt::format("{}: {:.1f} s{}, mount {}\n", report.log, report.logged_s(), holes_of(report), fdi::name_of(report.mount));
    for (const std::string& remark : report.remarks) text += fmt::format("  {}\n", remark);
    text += "\nInstruments\n";
    for (const InstrumentFacts& facts : report.instruments) text += instrument_text(facts);
    text += "\nFindings\n";
    for (const auto& finding : report.findings) text += fmt::format("  {}: {}\n", name_of(finding.certainty), statement_of(finding, report));
    if (report.findings.empty()) text += "  none\n";
    if (report.attitude)
        text += fmt::format("\nAttitude: with {0} among the others up to {1:.2f} degrees from that without it; {0} alone up to {2:.1f} degrees\n",
                            report.instruments[report.attitude->left_out].name, report.attitude->with_deg, report.attitude->alone_deg);
    if (!report.peers.empty()) text += "\nOther autopilots' rules on this log\n";
    for (const auto& peer : report.peers)
        text += fmt::format("  {}: {}{}\n", peer.rule, peer.finding, peer.at_s ? fmt::format(", at {:.2f} s", *peer.at_s) : "");
    return text;
}

}  // namespace quorient::cli
