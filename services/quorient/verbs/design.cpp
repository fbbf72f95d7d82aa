#include "cli/cluster_input.hpp"
#include "cli/json_output.hpp"
#include "cli/output_file.hpp"
#include "cli/parallel.hpp"
#include "cli/program.hpp"
#include "cli/progress.hpp"
#include "cli/design_input.hpp"
#include "quorient/geometry/figures.hpp"
#include "quorient/messages/units.hpp"
#include "report/design_explain.hpp"
#include "report/design_picture.hpp"
#include "report/design_report.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace quorient::cli {

namespace {

constexpr double ten_years_h = 87'660;
constexpr double usual_failures_per_h = 1e-6;

struct DesignOptions {
    std::string file;
    std::optional<unsigned> axes, pairs, triads;
    std::string mounting;
    std::vector<double> noise;
    std::optional<double> minimum_angle_deg;
    std::optional<unsigned> failures, detectable, isolable;
    std::string fault;
    std::string keep;
    std::vector<std::size_t> without;
    std::optional<double> mounting_error_deg, hours, failure_rate;
    std::string objective = "trace";
    std::uint64_t seed = 1;
    std::optional<unsigned> starts;
    unsigned designs = 5, threads = 0;
    std::string out;
    bool remove = false, explain = false, force = false, json = false;
};

std::vector<std::string> objective_names()
{
    std::vector<std::string> names;
    for (const auto& entry : design::objectives()) names.emplace_back(entry.name);
    return names;
}

design::Objective objective_of(const std::string& name)
{
    const auto& list = design::objectives();
    return std::ranges::find(list, name, &design::ObjectiveEntry::name)->objective;
}

/// What is left of a cluster; instruments without an axis are gone, the others are numbered anew.
geometry::SensorCluster part_of(const geometry::SensorCluster& cluster, AxisMask used)
{
    std::vector<std::size_t> owner, instrument;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis)
        if (has_axis(used, axis)) owner.push_back(cluster.instrument[axis]);
    std::vector<std::size_t> left = owner;
    std::ranges::sort(left);
    left.erase(std::unique(left.begin(), left.end()), left.end());
    for (const std::size_t index : owner) instrument.push_back(static_cast<std::size_t>(std::ranges::lower_bound(left, index) - left.begin()));
    auto part = geometry::make_cluster(geometry::select(cluster.axes, used), std::move(instrument));
    if (!part) fail("--without: " + part.error());
    for (std::size_t index = 0; index < left.size(); ++index) part->instrument_name[index] = cluster.instrument_name[left[index]];
    Eigen::Index next = 0;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis)
        if (has_axis(used, axis)) part->sigma(next++) = cluster.sigma(static_cast<Eigen::Index>(axis));
    return std::move(*part);
}

/// The array to start from: a file of axes, or a layout of the catalogue.
geometry::SensorCluster kept_cluster(const DesignOptions& options, const std::string& name)
{
    const bool is_file = std::filesystem::exists(name);
    auto cluster = load_cluster(is_file ? ClusterChoice{"", name} : ClusterChoice{name, ""});
    if (!cluster) fail("--keep: " + cluster.error());
    AxisMask used = cluster->all();
    for (const std::size_t axis : options.without) {
        if (axis >= cluster->size()) fail(fmt::format("--without {}: {} has axes 0..{}", axis, name, cluster->size() - 1));
        used &= ~axis_bit(axis);
    }
    return part_of(*cluster, used);
}

void keep(const DesignOptions& options, BriefFile& input)
{
    if (input.keep.empty()) {
        if (!options.without.empty()) fail("--without needs --keep");
        return;
    }
    const auto cluster = kept_cluster(options, input.keep);
    input.brief.kept = cluster.axes;
    input.brief.kept_instrument = cluster.instrument;
}

/// Options replace what the file says.
void apply(const DesignOptions& options, BriefFile& input)
{
    design::Brief& brief = input.brief;
    const auto take = [&](const std::optional<unsigned>& count, unsigned axes_each) {
        if (!count) return;
        brief.instruments = *count;
        brief.axes_each = axes_each;
        input.place.erase("axes");
    };
    take(options.axes, 1);
    take(options.pairs, 2);
    take(options.triads, 3);
    const auto replace = [&](const char* key, const auto& option, auto set) {
        if (!option) return;
        set(*option);
        input.place.erase(key);
    };
    replace("minimum_angle_deg", options.minimum_angle_deg, [&](double deg) { brief.minimum_angle_rad = deg * degree; });
    replace("failures", options.failures, [&](unsigned count) { brief.failures = count; });
    replace("detectable", options.detectable, [&](unsigned count) { brief.detectable = count; });
    replace("isolable", options.isolable, [&](unsigned count) { brief.isolable = count; });
    replace("mounting_error_deg", options.mounting_error_deg, [&](double deg) { brief.mounting_error_rad = deg * degree; });
    if (!options.noise.empty()) brief.noise = options.noise;
    if (!options.fault.empty()) brief.instrument_faults = options.fault == "instrument";
    if (!options.keep.empty()) input.keep = options.keep;
    if (options.mounting.empty()) return;
    const auto mounting = load_mounting(options.mounting);
    if (!mounting) fail("--mounting: " + mounting.error());
    brief.mounting = *mounting;
    input.place.erase("mounting");
}

/// The objectives that judge by something which has to be given.
void check_objective(const DesignOptions& options, const design::Brief& brief)
{
    if (objective_of(options.objective) == design::Objective::mounted_trace && brief.mounting_error_rad == 0)
        fail("--objective mounted_trace needs --mounting-error: how far instruments may be tilted");
}

/// A mission where one is asked for; the survival cannot be compared without.
void apply_mission(const DesignOptions& options, design::Brief& brief)
{
    if (options.failure_rate && !options.hours && !brief.mission && options.objective != "survival") fail("--failure-rate needs --hours");
    const bool wanted = options.hours || options.objective == "survival";
    if (wanted && !brief.mission) brief.mission = design::Mission{.hours = ten_years_h, .axis_failures_per_h = usual_failures_per_h};
    if (options.hours) brief.mission->hours = *options.hours;
    if (options.failure_rate) brief.mission->axis_failures_per_h = *options.failure_rate;
}

BriefFile read_brief(const DesignOptions& options)
{
    BriefFile input;
    if (!options.file.empty()) {
        auto read = load_brief(options.file);
        if (!read) fail(read.error());
        input = std::move(*read);
    }
    apply(options, input);
    apply_mission(options, input.brief);
    check_objective(options, input.brief);
    return input;
}

[[noreturn]] void refuse(const BriefFile& input, const design::Refusal& refusal)
{
    const auto place = input.place.find(refusal.demand);
    fail(place != input.place.end() ? fmt::format("{}: {}: {}", place->second, refusal.demand, refusal.reason)
                                    : fmt::format("{}: {}", refusal.demand, refusal.reason));
}

void print_removals(const DesignOptions& options, const BriefFile& input)
{
    if (input.keep.empty()) fail("--remove needs --keep: the array of which an axis is to go");
    if (input.brief.instruments > 0) fail("--remove asks which axis may go, --axes and --triads where new ones come: one at a time");
    const auto cluster = kept_cluster(options, input.keep);
    const bool instruments = input.brief.instrument_faults;
    const std::size_t units = instruments ? cluster.instrument_name.size() : cluster.size();
    if (cluster.size() <= 3 || units < 2)
        fail(fmt::format("--remove: {} has {} axes, and 3 are needed to measure a rotation", input.keep, cluster.size()));
    const auto list = design::removals(cluster, instruments, 1, objective_of(options.objective));
    if (options.json) fmt::print("{}\n", dump(removals_json(list, instruments)));
    else fmt::print("{}", removals_text(cluster, list, instruments));
}

std::string output_name(const DesignOptions& options, std::size_t place, std::string_view extension)
{
    return (std::filesystem::path(options.out) / fmt::format("design-{}{}", place + 1, extension)).string();
}

/// Ends the verb before the search where a file of an earlier one is in the way.
void look_at_outputs(const DesignOptions& options)
{
    if (!std::filesystem::is_directory(options.out)) return;
    for (std::size_t place = 0; place < options.designs; ++place)
        for (const char* extension : {".yaml", ".txt", ".svg"}) OutputFile(output_name(options, place, extension), options.force);
}

void write_file(const DesignOptions& options, std::size_t place, std::string_view extension, const std::string& text)
{
    OutputFile file(output_name(options, place, extension), options.force);
    file.stream() << text;
    file.finish_document();
}

/// The demands as they are typed, so that the files say how they came about.
std::string origin_of(const DesignOptions& options)
{
    std::string text = "quorient design";
    const auto add = [&](const char* name, const auto& value) { text += fmt::format(" {} {}", name, value); };
    const auto add_given = [&](const char* name, const auto& value) {
        if (value) add(name, *value);
    };
    const auto add_text = [&](const char* name, const std::string& value) {
        if (!value.empty()) add(name, value);
    };
    if (!options.file.empty()) text += ' ' + options.file;
    add_given("--axes", options.axes);
    add_given("--pairs", options.pairs);
    add_given("--triads", options.triads);
    add_text("--mounting", options.mounting);
    add_text("--noise", fmt::format("{}", fmt::join(options.noise, ",")));
    add_given("--minimum-angle", options.minimum_angle_deg);
    add_given("--failures", options.failures);
    add_text("--fault", options.fault);
    add_given("--detectable", options.detectable);
    add_given("--isolable", options.isolable);
    add_given("--mounting-error", options.mounting_error_deg);
    add_given("--hours", options.hours);
    add_given("--failure-rate", options.failure_rate);
    add_text("--keep", options.keep);
    add_text("--without", fmt::format("{}", fmt::join(options.without, ",")));
    add_given("--starts", options.starts);
    return text + fmt::format(" --objective {} --seed {}", options.objective, options.seed);
}

void write_files(const DesignOptions& options, const design::SearchResult& result)
{
    std::error_code problem;
    std::filesystem::create_directories(options.out, problem);
    if (problem) fail(fmt::format("--out {}: {}", options.out, problem.message()));
    for (std::size_t place = 0; place < result.designs.size(); ++place) {
        const design::Design& one = result.designs[place];
        write_file(options, place, ".yaml", axes_file_text(one, origin_of(options)));
        write_file(options, place, ".txt", design_table(one, result.bounds));
        write_file(options, place, ".svg", array_picture(one.cluster, fmt::format("design {}: {} axes", place + 1, one.cluster.size())));
    }
}

/// Work on all cores, with a bar on stderr where it takes long.
design::ForEach on_all_cores(const DesignOptions& options, Progress& progress)
{
    return [threads = options.threads, &progress](std::size_t count, const std::function<void(std::size_t)>& task) {
        for_each(count, threads, [&progress](std::size_t done, std::size_t all) { progress.show(done, all); }, task);
    };
}

design::SearchResult run_search(const DesignOptions& options, const BriefFile& input, const design::ForEach& for_each)
{
    const design::SearchSettings settings{objective_of(options.objective), options.seed,
                                          options.starts.value_or(static_cast<unsigned>(design::starts_for(input.brief.axis_count()))),
                                          options.designs};
    auto result = design::search(input.brief, settings, for_each);
    if (!result) refuse(input, result.error());
    return std::move(*result);
}

/// The result in the form that is asked for.
std::string answer(const DesignOptions& options, const design::Brief& brief, const design::SearchResult& result, const design::ForEach& for_each)
{
    if (options.json) return dump(design_json(result)) + '\n';
    if (options.explain && !result.designs.empty()) return explained(brief, result, options.seed, for_each);
    return design_text(brief, result, objective_of(options.objective));
}

/// Demands that the result does not meet, on stderr.
void report_unmet(const design::Brief& brief, const design::SearchResult& result)
{
    if (result.designs.empty()) {
        const bool flat = !result.nearest.empty() && !std::isfinite(result.nearest.front().figures.trace);
        if (flat) fmt::print(stderr, "no array found measures all rotations: in every one that was tried the axes lie in one plane\n");
        else if (result.searched == design::Searched::wholly)
            fmt::print(stderr, "none of all {} choices of places meets all demands\n", result.tried);
        else fmt::print(stderr, "no array found meets all demands; no bound is known that forbids it\n");
        throw Exit{ExitCode::not_as_asked};
    }
    const design::Figures& best = result.designs.front().figures;
    if (design::names_failures(best, brief)) return;
    fmt::print(stderr,
               "note: no array found lets parity name {} failures one after another, whatever their sizes; the first design names {}\n",
               *brief.failures, design::named_in_turn(best));
}

void run(const DesignOptions& options)
{
    BriefFile input = read_brief(options);
    if (options.remove) return print_removals(options, input);
    if (input.brief.instruments == 0)
        fail("nothing to design: give --axes N, --pairs N or --triads N, or a brief; with --keep, --remove asks which axis may go");
    keep(options, input);
    if (!options.out.empty()) look_at_outputs(options);
    auto progress = std::make_unique<Progress>();
    const design::ForEach for_each = on_all_cores(options, *progress);
    const design::SearchResult result = run_search(options, input, for_each);
    const std::string text = answer(options, input.brief, result, for_each);
    progress.reset();  // takes its bar away before anything is printed
    if (!options.out.empty()) write_files(options, result);
    fmt::print("{}", text);
    report_unmet(input.brief, result);
}

constexpr settings::Bounds some_axes{.lowest = 1, .highest = max_axes};
constexpr settings::Bounds any_axes{.lowest = 0, .highest = max_axes};
constexpr settings::Bounds right_angle{.lowest = 0, .highest = 90};

void add_demands(Verb& verb, DesignOptions& options)
{
    const auto axes = verb.option("--axes", options.axes, "that many single-axis sensors").within(some_axes);
    const auto pairs = verb.option("--pairs", options.pairs, "that many instruments of two right-angled axes").within(some_axes);
    const auto triads = verb.option("--triads", options.triads, "that many instruments of three right-angled axes").within(some_axes);
    pairs.in_place_of({axes});
    triads.in_place_of({axes, pairs});
    verb.option("--mounting", options.mounting, "free, cone, right-angles, or a file (faces, wedges, symmetric, mirror)");
    verb.numbers("--noise", options.noise, 0, "of the axes of each instrument, any unit (default: 1)").within(settings::above_zero);
    verb.option("--minimum-angle", options.minimum_angle_deg, "between axes of different instruments, deg").within(right_angle);
    verb.option("--failures", options.failures, "after which the array must still measure, each named if possible (default: judged after 1 and 2)")
        .within(any_axes);
    verb.option("--fault", options.fault, "what a failure takes: axis (default) or instrument").one_of({"axis", "instrument"});
    verb.option("--detectable", options.detectable, "simultaneous faults to be detected whatever their sizes").within(any_axes);
    verb.option("--isolable", options.isolable, "simultaneous faults to be isolated whatever their sizes").within(any_axes);
    verb.option("--mounting-error", options.mounting_error_deg, "of every instrument, deg: also judge the array as it will be mounted")
        .within(right_angle);
    verb.option("--hours", options.hours, "of the mission that is to be survived (default: none)").within(settings::above_zero);
    verb.option("--failure-rate", options.failure_rate, "of an axis, per hour (default with a mission: 1e-6)").within({.lowest = 0, .highest = 1});
}

void add_outputs(Verb& verb, DesignOptions& options)
{
    verb.option("--objective", options.objective, "what decides first").one_of(objective_names()).shows_default();
    verb.option("--seed", options.seed, "of the starts and missions").shows_default();
    verb.option("--starts", options.starts, "random ones (default: 24 up to 12 axes, 8 up to 16, 2 above)").within({.lowest = 1, .highest = 1e6});
    verb.option("--designs", options.designs, "to print at most").within({.lowest = 1, .highest = 100}).shows_default();
    verb.option("--threads", options.threads, "0 = one for each core; the result is the same").within({.lowest = 0, .highest = 1024}).shows_default();
    verb.option("--out", options.out, "a folder for design-N.yaml (axes), design-N.txt (table) and design-N.svg (picture)");
    add_force(verb, options.force);
    const auto explain = verb.flag("--explain", options.explain, "one page in plain words in place of the table");
    verb.flag("--json", options.json, "one line of JSON, 17 significant digits, null where undefined").in_place_of({explain});
}

}  // namespace

void add_design(Program& program)
{
    auto verb = program.verb("design", "Which array should I build? Searches for the best axes, and judges them.");
    std::string list = "Objectives:\n";
    for (const auto& entry : design::objectives()) list += fmt::format("  {:<16}{} [{}]\n", entry.name, entry.summary, entry.source);
    verb.footer(list +
                "\nA brief is a YAML file with the same demands and more; options replace its values (docs/design-an-array.md).\n"
                "Demands that no array can meet are refused with the bound that forbids them.\n\n"
                "Examples: six axes; three triads on wedges; where to add an axis to an array; which axis may go\n"
                "  quorient design --axes 6 --explain\n"
                "  quorient design --triads 3 --mounting wedges.yaml --out designs\n"
                "  quorient design --keep cone-4 --axes 1\n"
                "  quorient design --keep triads-8 --remove\n");
    const auto options = std::make_shared<DesignOptions>();
    verb.option("brief", options->file, "a brief (YAML)").value_name("BRIEF");
    add_demands(verb, *options);
    verb.option("--keep", options->keep, "a layout, or a file of axes: they stay, --axes or --triads come in addition");
    verb.numbers("--without", options->without, 0, "axes of --keep to leave out, as in 0,3");
    verb.flag("--remove", options->remove, "which axis (--fault instrument: which instrument) of --keep may go at least cost");
    add_outputs(verb, *options);
    verb.not_as_asked_if("no array was found that meets the demands");
    verb.run([options] { run(*options); });
}

}  // namespace quorient::cli
