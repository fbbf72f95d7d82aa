#include "report/diagnosis_text.hpp"

#include "quorient/diagnosis/words.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <cmath>
#include <numbers>
#include <optional>

namespace quorient::cli {
namespace {

using diagnosis::InstrumentFacts;
using diagnosis::Report;

constexpr double degree = std::numbers::pi / 180;

std::string three(const std::optional<Eigen::Vector3d>& values, int digits)
{
    if (!values) return "-";
    std::string text;
    for (const double value : *values) {
        text += text.empty() ? "" : " ";
        text += std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
    }
    return text;
}

std::string turn_of(const InstrumentFacts& facts)
{
    if (!facts.rotation) return "-";
    const Eigen::AngleAxisd turn(*facts.rotation);
    const double angle_deg = turn.angle() / degree;
    if (angle_deg < 0.05) return "0";
    return fmt::format("{:.1f} about ({:.2f} {:.2f} {:.2f})", angle_deg, turn.axis().x(), turn.axis().y(), turn.axis().z());
}

void add_troubles(const InstrumentFacts& facts, std::string& text)
{
    const recording::InstrumentFigures& figures = facts.figures;
    const auto add = [&](std::uint64_t count, std::string_view what) {
        if (count > 0) text += fmt::format(", {} {}", count, what);
    };
    if (figures.gaps > 0) text += fmt::format(", {} gaps (longest {:.3f} s)", figures.gaps, figures.longest_gap_s);
    add(figures.lost + facts.clock.lost, "samples lost");
    add(figures.duplicates, "duplicates");
    add(figures.steps_back, "steps back in time");
    add(figures.not_finite, "without a value");
    const auto& clipped = figures.clipping_logged ? figures.clipped : figures.at_extreme;
    add(clipped[0] + clipped[1] + clipped[2], figures.clipping_logged ? "clipped" : "at the largest value");
}

std::string instrument_text(const InstrumentFacts& facts)
{
    const recording::InstrumentFigures& figures = facts.figures;
    std::string text = fmt::format("  {}: {:.2f} Hz, jitter {:.2f} ms, coverage {:.1f} %", facts.name, figures.rate_hz(), figures.jitter_s * 1e3,
                                   100 * figures.coverage);
    add_troubles(facts, text);
    if (facts.clock.tied) text += fmt::format(", clock {:+.2f} ms", facts.clock.offset_s * 1e3);
    if (facts.clock.own_clock) text += fmt::format(", stamps late by up to {:.0f} ms", facts.clock.late_most_s * 1e3);
    if (std::isfinite(figures.temperature_min_c)) text += fmt::format(", {:.0f} to {:.0f} degrees C", figures.temperature_min_c, figures.temperature_max_c);
    text += '\n';
    if (!facts.compared) return text + "      not compared\n";
    text += fmt::format("      bias {} deg/s ({}), gain {}, turned {} degrees\n", three(facts.bias_deg_s, 2), facts.bias_from_rest ? "at rest" : "against the others",
                        three(facts.gain, 3), turn_of(facts));
    text += fmt::format("      noise {} deg/s at rest, {} against the others in motion\n", three(facts.noise_rest_deg_s, 3), three(facts.noise_motion_deg_s, 2));
    return text;
}

std::string finding_text(const diagnosis::Finding& finding, const Report& report)
{
    return fmt::format("  {}: {} {} {}\n", name_of(finding.certainty), place_of(finding, report), words_of(finding), time_of(finding, report));
}

}  // namespace

std::string diagnosis_text(const Report& report)
{
    std::string text = report.sentence + "\n\n";
    text += fmt::format("{}: {:.1f} s, mount {}\n", report.log, report.duration_s, fdi::name_of(report.mount));
    for (const std::string& remark : report.remarks) text += fmt::format("  {}\n", remark);
    text += "\nInstruments\n";
    for (const InstrumentFacts& facts : report.instruments) text += instrument_text(facts);
    text += "\nFindings\n";
    for (const auto& finding : report.findings) text += finding_text(finding, report);
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
