#include "cli/csv_input.hpp"
#include "cli/program.hpp"
#include "cli/json_output.hpp"
#include "quorient/attitude/propagator.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace quorient::cli {

namespace {

struct PropagateOptions {
    std::string algorithm = "window-10";
    double interval_s = 0;
    std::vector<double> initial{1, 0, 0, 0};
    std::string file = "-";
    bool list = false;
    bool json = false;
};

attitude::Quaternion initial_of(const PropagateOptions& options)
{
    if (options.initial.size() != 4) fail("--initial takes four numbers w,x,y,z, as in 1,0,0,0");
    const attitude::Quaternion initial(options.initial[0], options.initial[1], options.initial[2], options.initial[3]);
    if (!(std::abs(initial.norm() - 1) <= 1e-4))
        fail(fmt::format("--initial must be a unit quaternion, its norm is {:.6g}", initial.norm()));
    return initial.normalized();
}

void print_list(bool json)
{
    for (const auto& entry : attitude::update_catalogue()) {
        if (json) fmt::print("{}\n", dump({{"name", entry.name}, {"equation", entry.equation}, {"source", entry.source}}));
        else fmt::print("{:<20} {}  [{}]\n", entry.name, entry.equation, entry.source);
    }
}

void print_row(std::size_t row, const attitude::Quaternion& q, bool json)
{
    if (json) return fmt::print("{}\n", dump({{"row", row}, {"attitude", attitude::to_array(q)}}));
    if (row == 0) fmt::print("row,q_w,q_x,q_y,q_z\n");
    fmt::print("{},{:.17g},{:.17g},{:.17g},{:.17g}\n", row, q.w(), q.x(), q.y(), q.z());
}

void run(const PropagateOptions& options)
{
    if (options.list) return print_list(options.json);
    if (!(options.interval_s > 0) || !std::isfinite(options.interval_s))
        fail("--interval is needed: the time that each row spans, above 0 s, as in --interval 0.01");
    auto update = attitude::make_update(options.algorithm);
    if (!update) fail(fmt::format("--algorithm: {}", update.error()));
    attitude::Propagator propagator(std::move(*update), initial_of(options));

    auto input = CsvReader::open(options.file, {.columns = 3});
    if (!input) fail(input.error());
    constexpr double largest_rad = 1e6;
    CsvRow row;
    for (std::size_t number = 0;; ++number) {
        const auto more = input->next(row);
        if (!more) fail(more.error());
        if (!*more && number == 0) fail(input->nothing());
        if (!*more) return;
        const Eigen::Vector3d increment(row.value[0], row.value[1], row.value[2]);
        if (!(increment.cwiseAbs().maxCoeff() <= largest_rad))
            fail(input->at(row.line, 0, "an increment beyond 1e6 rad is no rotation of one interval; are the units rad?"));
        print_row(number, propagator.add({increment, options.interval_s}), options.json);
    }
}

}  // namespace

void add_propagate(Program& program)
{
    auto verb = program.verb("propagate", "Body increments in, the attitude at the end of every row out.");
    verb.footer(
        "Rows are three body increments (rad), the integral of the body rate over one interval. Output: row,q_w,q_x,q_y,q_z, body to "
        "reference.\n"
        "Algorithms: quorient propagate --list. The default fits the newest ten rows.\n\n"
        "Example: a quarter turn about z in ten rows\n"
        "  yes 0,0,0.15707963267948966 | head -10 | quorient propagate --algorithm window-10 --interval 0.01\n");
    const auto options = std::make_shared<PropagateOptions>();
    verb.option("--algorithm", options->algorithm, "single, previous, two-sample, ..., window-N").shows_default();
    verb.option("--interval", options->interval_s, "that each row spans, s").within(settings::above_zero);
    verb.numbers("--initial", options->initial, 4, "attitude before the first row, w,x,y,z");
    verb.option("file", options->file, "rows of increments; - is standard input").value_name("FILE").shows_default();
    verb.flag("--list", options->list, "the algorithms with their equations and sources, instead");
    verb.flag("--json", options->json, "one JSON object per row");
    verb.run([options] { run(*options); });
}

}  // namespace quorient::cli
