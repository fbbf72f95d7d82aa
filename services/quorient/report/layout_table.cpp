#include "layout_table.hpp"

#include "cli/json_output.hpp"
#include "quorient/geometry/figures.hpp"
#include "quorient/geometry/layouts.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <vector>

namespace quorient::cli {

namespace {

geometry::SensorCluster named(std::string_view name)
{
    return geometry::layout(name).value();
}

// Paper 004, Table 4

struct Architecture {
    std::string_view matrix, layout;
    double printed;
    std::string_view reason;
};

const std::vector<Architecture>& architectures()
{
    static const std::vector<Architecture> rows{
        {"H1", "dodecahedron-h1", 5.0, ""},
        {"H2", "dodecahedron-h2", 5.0, ""},
        {"H3", "octahedron-6", 4.0, ""},
        {"H4", "orthogonal-3", 0, "undefined: three axes have no parity equation; the paper writes 0"},
        {"H5", "tetrad", 1, ""},
        {"H6", "tetrad-2", 1, ""},
        {"H7", "cone-5", 1.52, "1 / cos^2 36 deg, printed truncated"},
        {"H8", "octahedron-8", 3.36, "printed is the ratio of rounded J: .625 / .186"},
        {"H9", "tdof-symmetric", 3.3, "printed truncated"},
        {"H10", "tdof-orthogonal", 1.8, "16/9 with the partner axis of the same gyro left out, a rule the paper does not state"},
        {"H11", "tdof-coplanar", 3.7,
         "axis 7 corrected (printed as axis 5 again); partner axis left out; by eq. (42) literally it would rank second"},
    };
    return rows;
}

struct Merit {
    double f_d1, literal, partner_excluded;

    /// By the rule that the paper really used.
    double compared() const { return std::isnan(partner_excluded) ? literal : partner_excluded; }
};

Merit merit_of(const Architecture& row)
{
    const auto cluster = named(row.layout);
    const geometry::ParitySpace space(cluster.axes);
    return {geometry::f_d1(space), geometry::f_d2(space),
            geometry::f_d2_partner_excluded(cluster.axes, cluster.instrument).value_or(undefined)};
}

// Paper 002, accuracy with up to two axes removed

constexpr std::array<std::string_view, 6> figure_names{"lambda_1", "lambda_2", "lambda_3", "trace", "volume", "condition"};
using Figures = std::array<double, 6>;

struct AccuracyCase {
    std::string_view layout, removed;
    std::vector<std::vector<std::size_t>> sets;
    Figures printed;
    std::string_view wrong_figure{};
    std::string_view reason{};
};

std::vector<std::vector<std::size_t>> pairs(std::size_t least_step, std::size_t most_step)
{
    std::vector<std::vector<std::size_t>> found;
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = i + 1; j < 6; ++j)
            if (const std::size_t step = std::min(j - i, 6 - (j - i)); step >= least_step && step <= most_step) found.push_back({i, j});
    return found;
}

const std::vector<std::vector<std::size_t>> singles{{0}, {1}, {2}, {3}, {4}, {5}};
constexpr std::string_view lost_fraction = "printed 2 for 1/2, as the printed trace shows";

const std::vector<AccuracyCase>& accuracy_cases()
{
    static const std::vector<AccuracyCase> cases{
        {"dodecahedron", "none", {{}}, {.5, .5, .5, 1.5, .3535, 1}},
        {"cone-6", "none", {{}}, {.5, .5, .5, 1.5, .3535, 1}},
        {"dodecahedron", "any one", singles, {1, .5, .5, 2, .5, 2}},
        {"cone-6", "any one", singles, {1, .5, .5, 2, .5, 2}},
        {"dodecahedron", "any two", pairs(1, 3), {1.809, .691, 2, 3, .791, 3.618}, "lambda_3", lost_fraction},
        {"cone-6", "two neighbours", pairs(1, 1), {3, .6, .5, 4.1, .949, 6}},
        {"cone-6", "two with one between", pairs(2, 2), {1, 1, 2, 2.5, .707, 2}, "lambda_3", lost_fraction},
        {"cone-6", "two opposite", pairs(3, 3), {1.5, .75, .5, 2.75, .75, 3}},
        {"cone-6",
         "mean of the 15 pairs",
         pairs(1, 3),
         {undefined, undefined, undefined, 3.19, .802, 3.8},
         "volume",
         "printed is the mean of the three classes; the other columns weigh them by their pairs"},
    };
    return cases;
}

/// The mean over the sets of the case.
Figures figures_of(const AccuracyCase& one)
{
    const auto axes = named(one.layout).axes;
    Figures mean{};
    for (const auto& removed : one.sets) {
        AxisMask used = all_axes(6);
        for (const std::size_t axis : removed) used &= ~axis_bit(axis);
        const auto accuracy = geometry::accuracy(axes, used).value();
        const Figures figures{accuracy.eigenvalues(0), accuracy.eigenvalues(1), accuracy.eigenvalues(2),
                              accuracy.trace,          accuracy.volume,         accuracy.condition};
        for (std::size_t k = 0; k < figures.size(); ++k) mean[k] += figures[k] / static_cast<double>(one.sets.size());
    }
    return mean;
}

std::string table_cell(double value)
{
    if (!std::isfinite(value)) return fmt::format("{:>12}", "-");
    return fmt::format("{:>12.4f}", std::abs(value) < 5e-5 ? 0 : value);
}

void append_table_4(std::string& text)
{
    text +=
        "Paper 004, Table 4: F_d2 (ours with the partner axis of a two-axis gyro left out, as in the paper's Tables 1-3)\n"
        "No reason is given for differences below one unit of the last printed digit.\n";
    fmt::format_to(std::back_inserter(text), "{:<4} {:<16}{:>12}{:>12}{:>12}{:>12}{:>12}  {}\n", "", "layout", "printed", "ours",
                   "difference", "by eq. (42)", "F_d1", "reason");
    for (const Architecture& row : architectures()) {
        const Merit merit = merit_of(row);
        fmt::format_to(std::back_inserter(text), "{:<4} {:<16}{}{}{}{}{}  {}\n", row.matrix, row.layout, table_cell(row.printed),
                       table_cell(merit.compared()), table_cell(merit.compared() - row.printed), table_cell(merit.literal),
                       table_cell(merit.f_d1), row.reason);
    }
}

void append_accuracy(std::string& text)
{
    text += "\nPaper 002: eigenvalues, trace, volume and condition of (H'H)^-1 without some axes\n";
    fmt::format_to(std::back_inserter(text), "{:<14}{:<22}{:<10}{:>12}{:>12}{:>12}  {}\n", "layout", "axes removed", "figure", "printed",
                   "ours", "difference", "reason");
    for (const AccuracyCase& one : accuracy_cases()) {
        const Figures ours = figures_of(one);
        for (std::size_t k = 0; k < ours.size(); ++k) {
            if (std::isnan(one.printed[k])) continue;
            fmt::format_to(std::back_inserter(text), "{:<14}{:<22}{:<10}{}{}{}  {}\n", one.layout, one.removed, figure_names[k],
                           table_cell(one.printed[k]), table_cell(ours[k]), table_cell(ours[k] - one.printed[k]),
                           figure_names[k] == one.wrong_figure ? one.reason : "");
        }
    }
}

}  // namespace

Json papers_tables_json()
{
    Json table_4 = Json::array();
    for (const Architecture& row : architectures()) {
        const Merit merit = merit_of(row);
        table_4.push_back({{"architecture", row.matrix},
                           {"layout", row.layout},
                           {"F_d2_printed", row.printed},
                           {"F_d2", merit.literal},
                           {"F_d2_partner_excluded", merit.partner_excluded},
                           {"difference", merit.compared() - row.printed},
                           {"F_d1", merit.f_d1},
                           {"reason", row.reason}});
    }
    Json accuracy = Json::array();
    for (const AccuracyCase& one : accuracy_cases()) {
        const Figures ours = figures_of(one);
        for (std::size_t k = 0; k < ours.size(); ++k)
            if (!std::isnan(one.printed[k]))
                accuracy.push_back({{"layout", one.layout},
                                    {"removed", one.removed},
                                    {"figure", figure_names[k]},
                                    {"printed", one.printed[k]},
                                    {"ours", ours[k]},
                                    {"difference", ours[k] - one.printed[k]},
                                    {"reason", figure_names[k] == one.wrong_figure ? one.reason : ""}});
    }
    return {{"paper_004_table_4", std::move(table_4)}, {"paper_002_accuracy", std::move(accuracy)}};
}

std::string papers_tables_text()
{
    std::string text;
    append_table_4(text);
    append_accuracy(text);
    return text;
}

}  // namespace quorient::cli
