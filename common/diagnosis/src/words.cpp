#include "words.hpp"

#include "quorient/diagnosis/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace quorient::diagnosis {
namespace {

struct KindWords {
    Kind kind;
    std::string_view name;
    std::string_view unit;
};

constexpr std::array kinds{KindWords{Kind::bias, "bias", "deg/s"}, KindWords{Kind::gain, "gain", ""},
                           KindWords{Kind::sign, "sign", ""}, KindWords{Kind::delay, "delay", "s"},
                           KindWords{Kind::stuck, "stuck", ""}, KindWords{Kind::zero, "zero", ""},
                           KindWords{Kind::saturated, "saturated", ""}, KindWords{Kind::noise, "noise", "times"},
                           KindWords{Kind::spikes, "spikes", "deg/s"}, KindWords{Kind::mounting, "mounting", "deg"},
                           KindWords{Kind::outside_class, "class", "deg/s"}, KindWords{Kind::time, "time", "s"},
                           KindWords{Kind::missing, "missing", "s"}, KindWords{Kind::unit, "unit", "times"}};

const KindWords& words(Kind kind)
{
    return *std::find_if(kinds.begin(), kinds.end(), [&](const KindWords& w) { return w.kind == kind; });
}

constexpr double least_duration_s = 2.0;
constexpr double shown_deg_s = 0.05;  // less is 0.0 in the words
constexpr double at_once_s = 1.5;  // a fault from the first second on

/// "0.47 +- 0.01"
std::string sized(double size, double uncertainty, int digits)
{
    if (!std::isfinite(uncertainty) || uncertainty <= 0) return fixed(size, digits);
    const double least = std::pow(10.0, -digits);  // what is more certain than the digits show is not called exact
    return fixed(size, digits) + " +- " + fixed(std::max(uncertainty, least), digits);
}

/// "10.7 +- 0.1 deg/s too little"
std::string too_much(double bias_deg_s, double uncertainty)
{
    return fmt::format("{} deg/s too {}", sized(std::abs(bias_deg_s), uncertainty, 1), bias_deg_s < 0 ? "little" : "much");
}

/// Instruments contradict each other, and none is to blame.
bool is_disagreement(const Finding& finding)
{
    return !finding.instrument && finding.kind == Kind::bias;
}

std::string deg_s(const Finding& finding, std::string_view unsized)
{
    if (!std::isfinite(finding.size)) return std::string(unsized);
    return "reads " + too_much(finding.size, finding.uncertainty);
}

std::string size_words(const Finding& finding)
{
    const bool known = std::isfinite(finding.size);
    switch (finding.kind) {
        case Kind::bias: return deg_s(finding, finding.instrument ? "contradicts the others" : "disagree");
        case Kind::outside_class: return deg_s(finding, "contradicts the others") + ", more than sound sensors of its class differ by";
        case Kind::gain: return "shows " + sized(finding.size, finding.uncertainty, 2) + " of the true rate";
        case Kind::sign: return "has the wrong sign";
        case Kind::delay: return known ? "is late by " + sized(finding.size * 1e3, finding.uncertainty * 1e3, 1) + " ms" : "is late";
        case Kind::stuck: return "is stuck at one value";
        case Kind::zero: return "is stuck at 0";
        case Kind::saturated:
            return finding.instrument ? "is at its range" : "are at their range together (the attitude cannot be trusted from there on)";
        case Kind::noise: return known ? fmt::format("has {:.0f} times its usual noise", finding.size) : "comes and goes";
        case Kind::spikes: return known ? fmt::format("has spikes of {:.0f} deg/s", finding.size) : "has spikes";
        case Kind::mounting: return known ? fmt::format("is mounted {:.0f} degrees off", finding.size) : "is mounted wrongly";
        case Kind::time: return "has time stamps that step back";
        case Kind::missing: return fmt::format("has no data for {:.1f} s", finding.size);
        case Kind::unit: return finding.size > 1 ? fmt::format("has numbers {:.4g} times too large: a wrong unit", finding.size)
                                                 : fmt::format("has numbers {:.4g} times too small: a wrong unit", 1 / finding.size);
    }
    return {};
}

std::vector<std::string> names_of(const std::vector<InstrumentIndex>& instruments, const Report& report)
{
    std::vector<std::string> names;
    for (const InstrumentIndex m : instruments) names.push_back(report.instruments[m].name);
    return names;
}

std::vector<InstrumentIndex> compared_of(const Report& report)
{
    std::vector<InstrumentIndex> compared;
    for (InstrumentIndex m = 0; m < report.instruments.size(); ++m)
        if (report.instruments[m].compared) compared.push_back(m);
    return compared;
}

std::string without_comparison(const Report& report, const std::vector<InstrumentIndex>& compared)
{
    if (report.instruments.size() == 1)
        return fmt::format("The log holds one gyro, {}: there is nothing to compare it with.", report.instruments.front().name);
    const auto partly = std::count_if(report.instruments.begin(), report.instruments.end(), [](const InstrumentFacts& f) { return !f.compared; });
    std::string sentence = compared.empty() ? "No gyro was logged at full rate"
                                            : fmt::format("Only {} was logged at full rate", report.instruments[compared.front()].name);
    sentence += compared.empty() ? ": nothing can be compared." : ": there is nothing to compare it with.";
    if (partly > 0) sentence += fmt::format(" Log all gyros at full rate to get a verdict ({} hold a part of the motion only).", partly);
    return sentence;
}

std::string others_agree(const Report& report, const std::vector<InstrumentIndex>& compared)
{
    std::set<InstrumentIndex> faulty;
    bool disagree = false;
    for (const Finding& finding : report.findings) {
        if (finding.certainty == Certainty::isolated && finding.instrument) faulty.insert(*finding.instrument);
        disagree = disagree || finding.certainty == Certainty::detected;
    }
    std::vector<InstrumentIndex> sound;
    for (const InstrumentIndex m : compared)
        if (faulty.count(m) == 0) sound.push_back(m);
    if (sound.empty()) return " No gyro is left that could be trusted.";
    if (disagree) return fmt::format(" {} are left, and something is wrong there too.", list_of(names_of(sound, report)));
    if (sound.size() == 1) return fmt::format(" {} is left, with nothing to check it.", list_of(names_of(sound, report)));
    return fmt::format(" {} agree: the vehicle could have flown on them.", list_of(names_of(sound, report)));
}

std::string faulty_sentence(const Report& report, const std::vector<InstrumentIndex>& compared)
{
    const Finding& first = report.findings.front();
    std::string sentence = statement_of(first, report) + ".";
    std::set<InstrumentIndex> also;
    for (const Finding& finding : report.findings)
        if (finding.certainty == Certainty::isolated && finding.instrument && finding.instrument != first.instrument)
            also.insert(*finding.instrument);
    if (!also.empty())
        sentence +=
            fmt::format(" {} too {} faulty.", list_of(names_of({also.begin(), also.end()}, report)), also.size() == 1 ? "is" : "are");
    return sentence + others_agree(report, compared);
}

std::string healthy_sentence(const Report& report, const std::vector<InstrumentIndex>& compared)
{
    std::string sentence = fmt::format("No gyro is faulty: {} agree over {:.0f} s.", list_of(names_of(compared, report)), report.logged_s());
    if (!report.holes.empty())
        sentence += fmt::format(" For {:.0f} s besides, the log holds nothing.", report.duration_s - report.logged_s());
    if (report.findings.empty()) return sentence;
    const Finding& first = report.findings.front();
    const std::string where =
        first.instrument ? report.instruments[*first.instrument].name : "between " + list_of(names_of(first.candidates, report));
    return sentence + fmt::format(" {} passed (the clearest: {}, {}).", counted(report.findings.size(), "short disagreement"), where,
                                  time_of(first, report));
}

}  // namespace

std::string_view name_of(Kind kind)
{
    return words(kind).name;
}

std::string_view unit_of(Kind kind)
{
    return words(kind).unit;
}

std::string_view name_of(Certainty certainty)
{
    switch (certainty) {
        case Certainty::isolated: return "isolated";
        case Certainty::detected: return "detected";
        case Certainty::transient: break;
    }
    return "transient";
}

double Report::logged_s() const
{
    double logged_s = duration_s;
    for (const Hole& hole : holes) logged_s -= hole.to_s - hole.from_s;
    return logged_s;
}

bool Report::judged() const
{
    return compared_of(*this).size() >= 2 && logged_s() >= least_duration_s;
}

bool Report::found_anything() const
{
    return std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.certainty != Certainty::transient; });
}

std::string fixed(double value, int digits)
{
    return fmt::format("{:.{}f}", std::abs(value) < std::pow(10.0, -digits) / 2 ? 0.0 : value, digits);
}

std::string counted(std::uint64_t count, std::string_view thing)
{
    return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string list_of(const std::vector<std::string>& names)
{
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) list += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
    return list;
}

std::string words_of(const Finding& finding)
{
    std::string text = size_words(finding);
    if (std::abs(finding.bias_deg_s.value_or(0)) >= shown_deg_s) text += " and reads " + too_much(*finding.bias_deg_s, 0);
    if (!finding.remark.empty()) text += " (" + finding.remark + ")";
    return text;
}

std::string place_of(const Finding& finding, const Report& report)
{
    if (finding.instrument) {
        const std::string& name = report.instruments[*finding.instrument].name;
        return finding.axis ? fmt::format("{} {}", name, "xyz"[*finding.axis]) : name;
    }
    const auto names = names_of(finding.candidates, report);
    if (is_disagreement(finding) || finding.kind == Kind::saturated) return list_of(names);
    std::string place;
    for (const std::string& name : names) place += (place.empty() ? "" : " or ") + name;
    return place;
}

std::string statement_of(const Finding& finding, const Report& report)
{
    return fmt::format("{} {} {}", place_of(finding, report), words_of(finding), time_of(finding, report));
}

std::string time_of(const Finding& finding, const Report& report)
{
    if (finding.to_s) return fmt::format("from {:.2f} s to {:.2f} s", finding.from_s, *finding.to_s);
    if (finding.from_s < at_once_s && report.duration_s > 2 * at_once_s) return "from the beginning of the log to its end";
    return fmt::format("from {:.2f} s on", finding.from_s);
}

std::string sentence_of(const Report& report)
{
    const auto compared = compared_of(report);
    const auto beyond = [&](InstrumentIndex m) { return report.instruments[m].figures.is_beyond_gyros(); };
    if (!compared.empty() && std::all_of(compared.begin(), compared.end(), beyond))
        return "The rates are larger than any gyro reads: their unit is probably wrong, and what follows means nothing until it is right.";
    const bool certain = !report.findings.empty() && report.findings.front().certainty == Certainty::isolated;
    if (certain) return faulty_sentence(report, compared);
    if (compared.size() < 2) return without_comparison(report, compared);
    if (!report.judged())
        return fmt::format("The log holds {:.1f} s: too little to judge {}.", report.logged_s(), list_of(names_of(compared, report)));
    if (!report.found_anything()) return healthy_sentence(report, compared);
    const Finding& first = report.findings.front();
    if (first.instrument || first.kind == Kind::saturated) return statement_of(first, report) + ".";
    const std::string names = list_of(names_of(first.candidates, report));
    const std::string how = first.kind == Kind::bias ? "" : " (one of them " + words_of(first) + ")";
    return fmt::format("{} disagree {}{}: with {} gyros nobody can say which one is wrong.", names, time_of(first, report), how,
                       first.candidates.size() == 2 ? "two" : "these");
}

}  // namespace quorient::diagnosis
