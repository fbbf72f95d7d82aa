#include "isolation_rows.hpp"

#include "quorient/fdi/noise.hpp"

#include <cmath>

namespace quorient::studies {

namespace {

constexpr double false_alarm = 1e-3;  // for every row with a chi-square test
constexpr std::nullopt_t none = std::nullopt;

fdi::DetectorSettings named(const char* name)
{
    fdi::DetectorSettings settings;
    settings.method = name;
    settings.sigma = 1;
    settings.pfa = false_alarm;
    return settings;
}

fdi::DetectorSettings with_tolerance(const char* name, double tolerance)
{
    fdi::DetectorSettings settings = named(name);
    settings.tolerance = tolerance;
    settings.max_faults = 2;
    settings.bare = true;  // the published rates are those of the bare rules
    return settings;
}

JudgeFactory guaranteed()
{
    fdi::DetectorSettings settings = named("guaranteed");
    settings.bound = 3.5;
    settings.threshold = 25;
    settings.max_faults = 2;
    return method(settings);
}

JudgeFactory relaxed_invariants()
{
    fdi::DetectorSettings settings = with_tolerance("invariants", 4);
    settings.relaxed = true;
    return method(settings);
}

std::vector<IsolationRow> published_rows()
{
    using Kind = IsolationRow::Kind;
    const double mean_tolerance = std::sqrt(fdi::chi_square_quantile(3, false_alarm));
    return {
        {"Bayes, known k", Kind::known_count, posterior_of_known_count(), {{{none, none, 74.7, none, 96.8}, {none, none, 75.1, none, 96.8}}}},
        {"ML, known k", Kind::known_count, likelihood_of_known_count(), {{{none, 99.6, 70.6, 100, 96.1}, {none, 99.0, 70.3, 100, 96.0}}}},
        {"ML sequential = subset, margin 0", Kind::ours, subset(eager), {{{99.9, 96.3, 64.9, 99.9, 96.1}, {99.9, 96.3, 63.4, 99.9, 96.0}}}},
        {"mean, 2 iterations",
         Kind::method,
         method(with_tolerance("mean", mean_tolerance)),
         {{{99.9, 96.4, 60.1, 100, 77.6}, {99.9, 96.4, 55.1, 100, 76.1}}}},
        {"invariants 3.29s",
         Kind::method,
         method(with_tolerance("invariants", 3.29)),
         {{{99.0, 74.3, 10.1, 99.6, 85.2}, {99.0, 58.4, 11.5, 99.6, 84.7}}}},
        {"invariants 4s",
         Kind::method,
         method(with_tolerance("invariants", 4)),
         {{{99.9, 66.4, 4.2, 100, 82.6}, {99.9, 47.3, 6.3, 99.6, 81.0}}}},
        {"voting, per component 4s",
         Kind::method,
         voting_by_component(4),
         {{{99.9, 66.5, 3.8, 100, 82.8}, {99.9, 47.2, 6.3, 99.6, 80.3}}},
         3000},
        {"guaranteed 3.5s, A = 25s", Kind::method, guaranteed(), {{{100, 0, 0, 92.6, 62.0}, {100, 0, 0, 91.4, 60.1}}}},
        {"subset, margin 9", Kind::method, subset({9, none}), {{{99.9, 94.5, 12.6, 99.9, 86.1}, {99.9, 94.5, 12.6, 99.9, 85.1}}}},
    };
}

}  // namespace

std::vector<IsolationRow> isolation_rows()
{
    std::vector<IsolationRow> rows = published_rows();
    rows.push_back({"invariants 4s, relaxed", IsolationRow::Kind::assumes, relaxed_invariants(), {}});
    rows.push_back({"voting, vector norm, pfa 1e-3", IsolationRow::Kind::method, method(named("voting")), {}});
    rows.push_back({"glt, pfa 1e-3 (1 fault)", IsolationRow::Kind::method, method(named("glt")), {}});
    rows.push_back({"parity-set, pfa 1e-3 (1 fault)", IsolationRow::Kind::method, method(named("parity-set")), {}});
    rows.push_back({"subset, careful", IsolationRow::Kind::ours, subset(careful), {}});
    return rows;
}

std::vector<OperatingPoint> operating_curve()
{
    std::vector<OperatingPoint> curve;
    for (const std::optional<double> doubt : {std::optional<double>(), careful.doubt})
        for (const double margin : {0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 9.0, 10.0, 12.0, 16.0}) curve.push_back({margin, doubt});
    return curve;
}

JudgeFactory subset(const OperatingPoint& point)
{
    fdi::DetectorSettings settings = named("subset");
    settings.max_faults = 2;
    settings.margin = point.margin;
    settings.doubt = point.doubt;
    return method(settings);
}

}  // namespace quorient::studies
