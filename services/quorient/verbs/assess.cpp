#include "cli/cluster_input.hpp"
#include "cli/csv_input.hpp"
#include "cli/details_json.hpp"
#include "cli/json_output.hpp"
#include "cli/program.hpp"
#include "quorient/fdi/methods.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace quorient::cli {

namespace {

constexpr std::array<std::string_view, 7> outcome_names{"warming_up", "healthy", "suspect", "isolated", "ambiguous", "refused", "blind"};

struct AssessOptions {
    ClusterChoice choice;
    fdi::DetectorSettings settings;
    std::vector<double> direction;
    std::string file = "-";
    std::string check;
    bool json = false;  ///< the only format
};

std::string_view outcome_name(fdi::Outcome outcome)
{
    return outcome_names[static_cast<std::size_t>(outcome)];
}

/// Methods that say something of rows without instruments.
std::vector<const fdi::Method*> offered()
{
    std::vector<const fdi::Method*> methods;
    for (const fdi::Method& method : fdi::methods())
        if (method.word != "auto" && method.input != fdi::MethodInput::instruments) methods.push_back(&method);
    return methods;
}

/// An option that the method would ignore is a mistake, not a wish.
void refuse_foreign_options(const Verb& verb, const fdi::Method& method)
{
    for (const fdi::Method* other : offered())
        for (const std::string_view setting : other->settings)
            if (verb.given(fmt::format("--{}", setting)) && std::ranges::find(method.settings, setting) == method.settings.end())
                fail(fmt::format("--{} means nothing to method {}, which takes --{}", setting, method.word, fmt::join(method.settings, ", --")));
}

std::optional<std::array<double, 3>> direction_of(const AssessOptions& options)
{
    if (options.direction.empty()) return {};
    const std::array<double, 3> direction{options.direction[0], options.direction[1], options.direction[2]};
    const bool finite = std::ranges::all_of(direction, [](double component) { return std::isfinite(component); });
    if (!finite || direction == std::array<double, 3>{}) fail("--direction must be finite and not zero");
    return direction;
}

Json row_json(std::size_t row, const fdi::Assessment& assessment, std::size_t axes)
{
    Json candidates = Json::array();
    for (std::size_t k = 0; k < assessment.candidate_count; ++k) candidates.push_back(axes_json(assessment.candidate[k]));
    Json residual = Json::array();
    for (std::size_t axis = 0; axis < axes; ++axis) residual.push_back(assessment.residual[axis]);

    Json object;
    object["row"] = row;
    object["outcome"] = outcome_name(assessment.outcome);
    object["isolated"] = axes_json(assessment.outcome == fdi::Outcome::isolated ? assessment.isolated : 0);
    object["candidates"] = std::move(candidates);
    object["statistic"] = assessment.statistic;
    object["threshold"] = assessment.threshold;
    object["residual"] = std::move(residual);
    return object;
}

void run(const AssessOptions& options, const Verb& verb)
{
    refuse_foreign_options(verb, *fdi::find_method(options.settings.method));
    if (options.choice.name().empty()) fail("which axes? --layout NAME of the catalogue (quorient layout lists it), or --axes FILE");
    const auto cluster = load_cluster(options.choice);
    if (!cluster) fail(cluster.error());
    auto settings = options.settings;
    settings.direction = direction_of(options);
    const auto detector = fdi::make_detector(settings, *cluster);
    if (!detector) fail(detector.error());
    auto input = CsvReader::open(options.file, {.columns = cluster->size()});
    if (!input) fail(input.error());

    bool as_expected = true;
    CsvRow row;
    fdi::Assessment assessment;
    std::size_t number = 0;
    for (;; ++number) {
        const auto more = input->next(row);
        if (!more) fail(more.error());
        if (!*more) break;
        (*detector)->assess(
            {.identity = {.epoch = 1, .sequence = number}, .interval_s = 1, .increment = row.value, .valid = cluster->all()}, assessment);
        Json object = row_json(number, assessment, cluster->size());
        for (const fdi::Detail& detail : (*detector)->details(assessment)) object[std::string(detail.name)] = json_of(detail.value);
        fmt::print("{}\n", dump(object));
        as_expected = as_expected && (options.check.empty() || options.check == outcome_name(assessment.outcome));
    }
    if (number == 0) fail(input->nothing());
    if (!as_expected) throw Exit{ExitCode::not_as_asked};
}

void add_method_options(Verb& verb, AssessOptions& options)
{
    fdi::DetectorSettings& settings = options.settings;
    const auto record = fdi::detector_record();
    std::vector<std::string> names;
    for (const fdi::Method* method : offered()) names.emplace_back(method->word);
    verb.option("--method", settings.method, "how to judge a row").required().one_of(names);
    verb.option("--tolerance", settings.tolerance,
                    "invariants: of |v'z|, v of unit norm; voting: of a difference's norm; mean: of "
                    "sqrt(SSE); extrapolation, vector: of |v'z|")
        .within(record, "tolerance");
    verb.option("--sigma", settings.sigma, "standard deviation of one axis's noise")
        .within(record, "sigma");
    verb.option("--pfa", settings.pfa, "probability of a false alarm per row (default 1e-6)")
        .within(record, "pfa");
    verb.option("--bound", settings.bound, "largest regular error of one axis")
        .within(record, "bound");
    verb.option("--threshold", settings.threshold,
                    "A: errors beyond it are faults (default: the least with which regular errors are never undecided)")
        .within(record, "threshold");
    verb.option("--max-faults", settings.max_faults,
                    "most simultaneous faults that are looked for (default 2, as far as the axes allow)")
        .within(record, "max_faults");
    verb.option("--margin", settings.margin,
                    "explanations that differ by less are ambiguous, in units of sigma^2 (default: subset 9, else 0)")
        .within(record, "margin");
    verb.option("--doubt", settings.doubt,
                    "subset: share of right isolations held back as suspect, to rule out one more small fault (default none)")
        .within(record, "doubt");
    verb.numbers("--direction", options.direction, 3, "guaranteed: also the interval along this body vector, as in 0,0,1");
    verb.flag("--instruments", settings.instruments, "subset: a fault takes a whole instrument");
    verb.flag("--relaxed", settings.relaxed, "invariants: where no pattern fits, leave out what the best quadruple leaves out");
    verb.flag("--bare", settings.bare, "mean, relaxed invariants: the paper's rule as such, which does not look for rivals");
}

}  // namespace

void add_assess(Program& program)
{
    auto verb = program.verb("assess", "Judges rows of measurements: which axes lie? One JSON object per row.");
    std::string footer =
        "One measurement per row, one number per axis, in any unit; --sigma, --bound, --threshold and --tolerance are in the same.\n"
        "Axes are 0-based, rows too. Fields of each method beside the common ones:\n";
    for (const fdi::Method* method : offered())
        if (!method->details.empty()) footer += fmt::format("  {:<14}{}\n", method->word, method->details);
    footer +=
        "\nExample: two of six gyros are wrong (deg/h)\n"
        "  echo -393.04,1075.35,-612.73,-593.11,1254.79,-761.19 |\n"
        "    quorient assess --method guaranteed --layout guaranteed-cone --bound 1 --threshold 10\n";
    verb.footer(footer);
    verb.not_as_asked_if("--check: a row has another outcome");

    const auto options = std::make_shared<AssessOptions>();
    add_cluster_options(verb, options->choice);
    add_method_options(verb, *options);
    verb.option("file", options->file, "CSV of measurements; '-' = stdin").value_name("FILE");
    verb.flag("--json", options->json, "one JSON object per row, which is the only format");
    verb.option("--check", options->check, "exit 1 unless this is the outcome of every row")
        .one_of(std::vector<std::string>(outcome_names.begin(), outcome_names.end()));
    verb.run([options, verb] { run(*options, verb); });
}

}  // namespace quorient::cli
