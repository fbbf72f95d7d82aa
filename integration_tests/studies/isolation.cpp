#include "isolation_rows.hpp"
#include "quorient/geometry/layouts.hpp"
#include "study.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace quorient::studies {

namespace {

constexpr double tolerated_wrong_percent = 0.2;
constexpr double suspicious = 4;  // standard errors of a difference, published error included

/// The tallies of one judge, in the order of layouts and cases.
using Cells = std::array<std::array<Tally, isolation_cases.size()>, isolation_layouts.size()>;

std::vector<Scene> scenes(const std::vector<IsolationRow>& rows, const std::vector<OperatingPoint>& curve)
{
    std::vector<Scene> all;
    for (const char* layout : isolation_layouts)
        for (const IsolationCase& one : isolation_cases) {
            Scene scene;
            scene.cluster = geometry::layout(layout).value();
            scene.faults = one.faults;
            for (const IsolationRow& row : rows) scene.judges.push_back(row.judge);
            for (const OperatingPoint& point : curve) scene.judges.push_back(subset(point));
            all.push_back(std::move(scene));
        }
    return all;
}

Cells cells_of(std::size_t judge, const std::vector<std::vector<Tally>>& tallies)
{
    Cells cells;
    for (std::size_t layout = 0; layout < cells.size(); ++layout)
        for (std::size_t one = 0; one < isolation_cases.size(); ++one)
            cells[layout][one] = tallies[layout * isolation_cases.size() + one][judge];
    return cells;
}

double worst_wrong(const Cells& cells)
{
    double worst = 0;
    for (const auto& layout : cells)
        for (const Tally& tally : layout) worst = std::max(worst, rate(tally.wrong, tally.trials()).percent);
    return worst;
}

/// Whether a judge of this kind judges the case: one that is given the number of faults is left out where there are none.
bool asked(IsolationRow::Kind kind, std::size_t one)
{
    return kind != IsolationRow::Kind::known_count || isolation_cases[one].faults.count > 0;
}

double mean_correct(const Cells& cells, IsolationRow::Kind kind = IsolationRow::Kind::ours)
{
    double sum = 0;
    double count = 0;
    for (const auto& layout : cells)
        for (std::size_t one = 0; one < layout.size(); ++one) {
            if (!asked(kind, one)) continue;
            sum += rate(layout[one].correct, layout[one].trials()).percent;
            ++count;
        }
    return sum / count;
}

/// Standard error of our rate minus the recomputed one, which is rounded to 0.1 and has an error of its own.
double error_of_difference(const Rate& ours, double published, double published_trials)
{
    constexpr double rounding = 0.1 / 3.4641;  // uniform in one last digit
    const double share = published / 100;
    const double theirs = 100 * std::sqrt(share * (1 - share) / published_trials);
    return std::sqrt(ours.error * ours.error + theirs * theirs + rounding * rounding);
}

const char* label(IsolationRow::Kind kind)
{
    switch (kind) {
        case IsolationRow::Kind::known_count:
            return "bound";
        case IsolationRow::Kind::assumes:
            return "takes 2";
        case IsolationRow::Kind::method:
            return "method";
        case IsolationRow::Kind::ours:
            return "ours";
    }
    return "";
}

/// The largest difference to a published rate, in its standard errors.
struct Extreme {
    double sigmas = 0;
    double difference = 0;
    std::string where;
};

std::string correct_table(std::size_t layout, const std::vector<IsolationRow>& rows, const std::vector<Cells>& cells, Extreme& extreme)
{
    std::string text = fmt::format("{:<33}", isolation_layouts[layout]);
    for (const IsolationCase& one : isolation_cases) fmt::format_to(std::back_inserter(text), "{:>24}", one.name);
    text += '\n';
    for (std::size_t k = 0; k < rows.size(); ++k) {
        fmt::format_to(std::back_inserter(text), "{:<33}", rows[k].name);
        for (std::size_t one = 0; one < isolation_cases.size(); ++one) {
            const Tally& tally = cells[k][layout][one];
            const Rate ours = rate(tally.correct, tally.trials());
            const auto published = rows[k].published[layout][one];
            const std::string own = asked(rows[k].kind, one) ? fmt::format("{:.2f}±{:.2f}", ours.percent, ours.error) : "-";
            if (!published) {
                fmt::format_to(std::back_inserter(text), "{:>12}{:>12}", own, "");
                continue;
            }
            const double difference = ours.percent - *published;
            const double sigmas = difference / error_of_difference(ours, *published, rows[k].published_trials);
            fmt::format_to(std::back_inserter(text), "{:>12}{:>6.1f}{:>+5.1f}{}", own, *published, difference,
                           std::abs(sigmas) > suspicious ? '!' : ' ');
            if (std::abs(sigmas) > std::abs(extreme.sigmas))
                extreme = {sigmas, difference,
                           fmt::format("{}, {}, {}", rows[k].name, isolation_layouts[layout], isolation_cases[one].name)};
        }
        text += '\n';
    }
    return text;
}

std::string failure_table(const std::vector<IsolationRow>& rows, const std::vector<Cells>& cells)
{
    std::string text =
        fmt::format("{:<33}{:<8}{:>12}{:>12}   wrong | missed, % (dodecahedron; cone-6)\n", "", "", "worst wrong", "correct");
    for (std::size_t k = 0; k < rows.size(); ++k) {
        fmt::format_to(std::back_inserter(text), "{:<33}{:<8}{:>12.3f}{:>12.2f}  ", rows[k].name, label(rows[k].kind),
                       worst_wrong(cells[k]), mean_correct(cells[k], rows[k].kind));
        for (const auto& layout : cells[k]) {
            for (std::size_t one = 1; one < layout.size(); ++one)
                fmt::format_to(std::back_inserter(text), " {:.2f}|{:.2f}", rate(layout[one].wrong, layout[one].trials()).percent,
                               rate(layout[one].missed, layout[one].trials()).percent);
            text += &layout == &cells[k].front() ? ";" : "\n";
        }
    }
    return text;
}

std::string point_name(const OperatingPoint& point)
{
    return fmt::format("{:>6g}{:>7}", point.margin, point.doubt ? fmt::format("{:g}", *point.doubt) : "-");
}

std::string curve_table(const std::vector<OperatingPoint>& curve, const std::vector<Cells>& cells)
{
    std::string text =
        fmt::format("{:>6}{:>7}{:>13}{:>9}   correct per case, % (dodecahedron; cone-6)\n", "margin", "doubt", "worst wrong", "correct");
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const double worst = worst_wrong(cells[k]);
        fmt::format_to(std::back_inserter(text), "{}{:>12.3f}{}{:>9.2f}  ", point_name(curve[k]), worst,
                       worst <= tolerated_wrong_percent ? ' ' : '!', mean_correct(cells[k]));
        for (const auto& layout : cells[k]) {
            for (const Tally& tally : layout)
                fmt::format_to(std::back_inserter(text), "{:>7.2f}", rate(tally.correct, tally.trials()).percent);
            text += &layout == &cells[k].front() ? " ;" : "\n";
        }
    }
    return text;
}

/// Where another method that does not know the number of faults is furthest above margin 0.
std::string eager_comparison(const std::vector<IsolationRow>& rows, const std::vector<Cells>& cells)
{
    const auto is_eager = [](const IsolationRow& row) { return row.kind == IsolationRow::Kind::ours; };
    const auto eager_row = static_cast<std::size_t>(std::find_if(rows.begin(), rows.end(), is_eager) - rows.begin());
    double lead = -100;
    std::string where;
    for (std::size_t k = 0; k < rows.size(); ++k)
        for (std::size_t layout = 0; layout < isolation_layouts.size(); ++layout)
            for (std::size_t one = 0; one < isolation_cases.size(); ++one) {
                if (rows[k].kind != IsolationRow::Kind::method) continue;
                const auto percent = [&](std::size_t row) {
                    return rate(cells[row][layout][one].correct, cells[row][layout][one].trials()).percent;
                };
                if (percent(k) - percent(eager_row) <= lead) continue;
                lead = percent(k) - percent(eager_row);
                where = fmt::format("{}, {}, {}", rows[k].name, isolation_layouts[layout], isolation_cases[one].name);
            }
    return fmt::format("subset, margin 0: the method furthest above it in any case: {:+.2f} ({})\n", lead, where);
}

/// How the careful point stands against every method that names as few wrong sets.
std::string comparison(const std::vector<IsolationRow>& rows, const std::vector<Cells>& cells)
{
    const Cells& ours = cells.back();
    std::string text = fmt::format("subset, careful (margin {:g}, doubt {:g}): worst wrong {:.3f} %\n", careful.margin,
                                   careful.doubt.value(), worst_wrong(ours));
    for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
        if (rows[k].kind != IsolationRow::Kind::method || worst_wrong(cells[k]) > tolerated_wrong_percent) continue;
        fmt::format_to(std::back_inserter(text), "  beside {:<32} correct, ours minus theirs:", rows[k].name);
        for (std::size_t layout = 0; layout < isolation_layouts.size(); ++layout) {
            for (std::size_t one = 0; one < isolation_cases.size(); ++one)
                fmt::format_to(std::back_inserter(text), " {:+.2f}",
                               rate(ours[layout][one].correct, ours[layout][one].trials()).percent -
                                   rate(cells[k][layout][one].correct, cells[k][layout][one].trials()).percent);
            text += layout == 0 ? " ;" : "\n";
        }
    }
    return text;
}

Json cells_json(const Cells& cells, IsolationRow::Kind kind, const Published& published)
{
    Json list = Json::array();
    for (std::size_t layout = 0; layout < cells.size(); ++layout)
        for (std::size_t one = 0; one < isolation_cases.size(); ++one) {
            if (!asked(kind, one)) continue;
            const Tally& tally = cells[layout][one];
            const Rate correct = rate(tally.correct, tally.trials());
            Json cell{{"layout", isolation_layouts[layout]},
                      {"case", isolation_cases[one].name},
                      {"correct_percent", correct.percent},
                      {"error", correct.error},
                      {"wrong_percent", rate(tally.wrong, tally.trials()).percent},
                      {"missed_percent", rate(tally.missed, tally.trials()).percent},
                      {"flagged_percent", rate(tally.flagged, tally.trials()).percent}};
            if (published[layout][one]) cell["published_percent"] = *published[layout][one];
            list.push_back(std::move(cell));
        }
    return list;
}

cli::Chart trade_chart(const std::vector<IsolationRow>& rows, const std::vector<Cells>& row_cells, const std::vector<OperatingPoint>& curve,
                       const std::vector<Cells>& curve_cells)
{
    cli::Chart chart{
        "What caution costs: means over both layouts and five cases", "worst unflagged wrong isolation, %", "correct, %", true, false, {}};
    chart.series = {{"subset over its margin", {}, cli::colour(0), true}, {"the same with doubt", {}, cli::colour(1), true}};
    for (std::size_t k = 0; k < curve.size(); ++k)
        chart.series[curve[k].doubt ? 1 : 0].points.emplace_back(worst_wrong(curve_cells[k]), mean_correct(curve_cells[k]));
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (rows[k].kind == IsolationRow::Kind::method || rows[k].kind == IsolationRow::Kind::ours)
            chart.series.push_back(
                {rows[k].name, {{worst_wrong(row_cells[k]), mean_correct(row_cells[k])}}, cli::colour(chart.series.size()), false});
    return chart;
}

cli::Chart margin_chart(std::size_t layout, const std::vector<OperatingPoint>& curve, const std::vector<Cells>& cells)
{
    cli::Chart chart{fmt::format("subset on the {}: correct over the margin, without doubt", isolation_layouts[layout]),
                     "margin, sigma^2",
                     "correct, %",
                     false,
                     false,
                     {}};
    for (std::size_t one = 0; one < isolation_cases.size(); ++one) {
        cli::Series series{isolation_cases[one].name, {}, cli::colour(one), true};
        for (std::size_t k = 0; k < curve.size(); ++k)
            if (!curve[k].doubt)
                series.points.emplace_back(curve[k].margin, rate(cells[k][layout][one].correct, cells[k][layout][one].trials()).percent);
        chart.series.push_back(std::move(series));
    }
    return chart;
}

}  // namespace

Report isolation(const RunSettings& settings, const OnProgress& on_progress)
{
    const auto rows = isolation_rows();
    const auto curve = operating_curve();
    const auto tallies = run(scenes(rows, curve), settings, on_progress);
    std::vector<Cells> row_cells;
    for (std::size_t k = 0; k < rows.size(); ++k) row_cells.push_back(cells_of(k, tallies));
    std::vector<Cells> curve_cells;
    for (std::size_t k = 0; k < curve.size(); ++k) curve_cells.push_back(cells_of(rows.size() + k, tallies));

    Report report;
    Extreme extreme;
    report.text =
        "Correct, %: ours ± standard error, recomputed, difference (!: beyond four standard errors of both). Noise N(0,1), random signs "
        "and "
        "axes.\nRows with known k are bounds: they are given how many faults there are.\n\n";
    for (std::size_t layout = 0; layout < isolation_layouts.size(); ++layout)
        report.text += correct_table(layout, rows, row_cells, extreme) + '\n';
    fmt::format_to(std::back_inserter(report.text), "largest difference: {:+.2f} ({:+.1f} standard errors): {}\n\n", extreme.difference,
                   extreme.sigmas, extreme.where);
    report.text +=
        "Without a flag: the worst case's wrong isolations, the mean correct rate, and wrong | missed in the cases with faults\n\n" +
        failure_table(rows, row_cells) + "\nOur method over its margin, and with doubt (!: above 0.2 % wrong in some case)\n\n" +
        curve_table(curve, curve_cells) + '\n' + eager_comparison(rows, row_cells) + comparison(rows, row_cells);

    for (std::size_t k = 0; k < rows.size(); ++k)
        report.json["rows"].push_back(
            {{"name", rows[k].name}, {"kind", label(rows[k].kind)}, {"cells", cells_json(row_cells[k], rows[k].kind, rows[k].published)}});
    for (std::size_t k = 0; k < curve.size(); ++k)
        report.json["curve"].push_back({{"margin", curve[k].margin},
                                        {"doubt", curve[k].doubt ? Json(*curve[k].doubt) : Json()},
                                        {"worst_wrong_percent", worst_wrong(curve_cells[k])},
                                        {"mean_correct_percent", mean_correct(curve_cells[k])},
                                        {"cells", cells_json(curve_cells[k], IsolationRow::Kind::ours, {})}});
    report.charts = {trade_chart(rows, row_cells, curve, curve_cells), margin_chart(0, curve, curve_cells),
                     margin_chart(1, curve, curve_cells)};
    return report;
}

}  // namespace quorient::studies
