// What each rule of the field detector is worth on recordings: the study `field` with one rule switched off at a time.

#include "field_runs.hpp"
#include "study.hpp"

#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <iterator>
#include <string_view>

namespace quorient::studies {
namespace {

struct Variant {
    std::string_view without;
    bool fdi::FieldRules::*rule;
};

constexpr std::array variants{
    Variant{"-", nullptr},
    Variant{"learning", &fdi::FieldRules::learning},
    Variant{"persistence", &fdi::FieldRules::persistence},
    Variant{"others must agree", &fdi::FieldRules::others_must_agree},
    Variant{"leave one out", &fdi::FieldRules::leave_one_out},
    Variant{"clipping", &fdi::FieldRules::clipping},
    Variant{"dead zone", &fdi::FieldRules::dead_zone},
    Variant{"smallest angle", &fdi::FieldRules::smallest_angle},
    Variant{"erratic", &fdi::FieldRules::erratic},
    Variant{"outside class", &fdi::FieldRules::outside_class},
    Variant{"brief gains", &fdi::FieldRules::brief_gains},
    Variant{"saturation", &fdi::FieldRules::saturation},
};

/// Trials with faults that shall be named, or with those that shall pass: in how many the faulty instrument was latched.
struct Named {
    std::size_t trials = 0;
    std::size_t latched = 0;

    void add(const FaultFigures& figures)
    {
        trials += figures.runs.size();
        for (const FaultRun& run : figures.runs) latched += studies::latched(run) ? 1 : 0;
    }
    double percent() const { return trials == 0 ? 0 : 100 * static_cast<double>(latched) / static_cast<double>(trials); }
};

fdi::FieldRules rules_of(const Variant& variant)
{
    fdi::FieldRules rules;
    if (variant.rule != nullptr) rules.*variant.rule = false;
    return rules;
}

std::string latched_text(const LogFigures& log)
{
    if (log.run.latched == 0) return "-";
    return fmt::format("{} at {:.2f} s", axis_names(log.description, log.run.latched), log.run.first_latched_s);
}

/// One line per log: who was latched, and how long anybody was left out.
void add_logs(const Variant& variant, std::string_view truth, const std::vector<LogFigures>& logs, Report& report, Json& json)
{
    for (const LogFigures& log : logs) {
        fmt::format_to(std::back_inserter(report.text), "| {} | {} | {} | {} | {} | {:.2f} % |\n", variant.without, log.name, log.instruments, truth,
                       latched_text(log), 100 * log.run.provisional_s / log.duration_s);
        json.push_back({{"log", log.name},
                        {"truth", truth},
                        {"latched_axes", log.run.latched},
                        {"left_out_s", log.run.provisional_s},
                        {"duration_s", log.duration_s}});
    }
}

/// One line: what became of the added faults.
void add_faults(const Variant& variant, const std::vector<FaultFigures>& faults, std::string& text, Json& json)
{
    Named lasting;
    Named passing;
    std::size_t wrong = 0;
    std::vector<double> out_s;
    for (const FaultFigures& figures : faults) {
        (figures.fault.passes ? passing : lasting).add(figures);
        for (const FaultRun& run : figures.runs) {
            wrong += run.wrong != 0 ? 1 : 0;
            if (!figures.fault.passes) out_s.push_back(run.protected_s);
        }
    }
    fmt::format_to(std::back_inserter(text), "| {} | {:.1f} | {:.2f} | {:.2f} | {:.1f} | {} of {} |", variant.without, lasting.percent(),
                   quantile(out_s, 0.5), quantile(out_s, 0.9), passing.percent(), wrong, lasting.trials + passing.trials);
    json["named_percent"] = lasting.percent();
    json["passing_latched_percent"] = passing.percent();
    json["wrong"] = wrong;
    for (const FaultFigures& figures : faults) {
        if (figures.fault.passes) continue;
        Named one;
        one.add(figures);
        fmt::format_to(std::back_inserter(text), " {:.0f} |", one.percent());
        json["named"][std::string(figures.fault.name)] = one.percent();
    }
    text += "\n";
}

std::string faults_heading()
{
    std::string names = "| without | named % | out s | p90 | passing ones latched % | wrong |";
    std::string rule = "|--|--|--|--|--|--|";
    for (const FieldFault& fault : field_faults()) {
        if (fault.passes) continue;
        fmt::format_to(std::back_inserter(names), " {} |", fault.name);
        rule += "--|";
    }
    return names + "\n" + rule + "\n";
}

}  // namespace

Report field_ablation(const RunSettings& settings, const OnProgress& on_progress)
{
    const std::vector<FieldLog> sound = load_field_logs(settings.logs);
    const std::vector<FieldLog> faulty = load_field_logs(settings.faulty_logs);
    Report report;
    report.text = fmt::format(
        "mount: {}; no log is calibrated; one rule is off at a time\n\n| without | log | instruments | truth | latched | left out |\n"
        "|--|--|--|--|--|--|\n",
        fdi::name_of(settings.mount));
    std::string faults = "\n## Faults added to the sound logs\n\n" + faults_heading();
    report.json["mount"] = fdi::name_of(settings.mount);
    report.json["variants"] = Json::array();
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const fdi::FieldRules rules = rules_of(variants[i]);
        Json json{{"without", variants[i].without}};
        Json logs = Json::array();
        add_logs(variants[i], "sound", play_logs(sound, settings, rules), report, logs);
        add_logs(variants[i], "faulty", play_logs(faulty, settings, rules), report, logs);
        json["logs"] = logs;
        const auto progress = [&](std::size_t done, std::size_t all) { on_progress(i * all + done, variants.size() * all); };
        add_faults(variants[i], inject_faults(sound, settings, progress, rules), faults, json);
        report.json["variants"].push_back(json);
    }
    report.text += faults;
    return report;
}

}  // namespace quorient::studies
