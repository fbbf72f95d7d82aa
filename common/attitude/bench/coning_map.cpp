// Coning drift of the window of ten against the 1/12 rule over half angle, frequency and sampling rate.
//   attitude_coning_map table              the table of docs/methods/coning.md
//   attitude_coning_map map FILE.svg [S]   the map, over S seconds (600)
#include "../test/coning.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace quorient::attitude;
using namespace quorient::attitude::testing;

constexpr std::array half_angles_deg{0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 60.0};
constexpr std::array frequencies_hz{0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0};
constexpr std::array samplings_hz{50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0};

struct Cell {
    double half_angle_deg;
    double frequency_hz;
    double sampling_hz;
    double window_deg_h;
    double previous_deg_h;

    bool promised() const { return frequency_hz <= sampling_hz / 10; }
    bool worse() const { return window_deg_h > previous_deg_h && window_deg_h > 1e-8; }
};

Cell measured(double half_angle_deg, double frequency_hz, double sampling_hz, double duration_s)
{
    const ClassicConing motion(half_angle_deg, frequency_hz);
    const auto rows = static_cast<std::uint64_t>(std::llround(duration_s * sampling_hz));
    const Wide interval_s = 1 / static_cast<Wide>(sampling_hz);
    Propagator window(make_update("window-10").value(), motion.attitude(0));
    Propagator previous(make_update("previous").value(), motion.attitude(0));
    for (std::uint64_t row = 0; row < rows; ++row) {
        const Sample sample{motion.increment(static_cast<Wide>(row) * interval_s, interval_s), static_cast<double>(interval_s)};
        window.add(sample);
        previous.add(sample);
    }
    const Quaternion truth = motion.attitude(static_cast<Wide>(rows) * interval_s);
    return {half_angle_deg, frequency_hz, sampling_hz, deg_per_hour(angle_between(window.attitude(), truth), duration_s),
            deg_per_hour(angle_between(previous.attitude(), truth), duration_s)};
}

std::vector<Cell> sweep(double duration_s)
{
    std::vector<Cell> cells;
    for (const double half_angle : half_angles_deg) {
        for (const double sampling : samplings_hz)
            for (const double frequency : frequencies_hz) cells.push_back(measured(half_angle, frequency, sampling, duration_s));
        std::fprintf(stderr, "%g deg done\n", half_angle);
    }
    return cells;
}

// Green at 1e-8 deg/h and below, through yellow, to red at 100 deg/h and above.
std::string colour(double drift_deg_h)
{
    const double place = std::min(1.0, std::max(0.0, (std::log10(std::max(drift_deg_h, 1e-12)) + 8) / 10));
    return "hsl(" + std::to_string(static_cast<int>(std::lround(130 * (1 - place)))) + ",65%,70%)";
}

std::string text(double value)
{
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.0e", value);
    return buffer.data();
}

constexpr int cell_width = 62;
constexpr int cell_height = 34;
constexpr int margin = 70;
constexpr int panel_height = margin + static_cast<int>(samplings_hz.size()) * cell_height;

void draw_cell(std::ofstream& svg, const Cell& cell, int x, int y)
{
    const char* border = cell.worse() ? "#c00000" : "#ffffff";
    svg << "<rect x='" << x << "' y='" << y << "' width='" << cell_width - 2 << "' height='" << cell_height - 2 << "' fill='"
        << colour(cell.window_deg_h) << "' stroke='" << border << "' stroke-width='2'" << (cell.promised() ? "" : " fill-opacity='0.35'")
        << "/>\n"
        << "<text x='" << x + cell_width / 2 - 1 << "' y='" << y + 14 << "'>" << text(cell.window_deg_h) << "</text>"
        << "<text x='" << x + cell_width / 2 - 1 << "' y='" << y + 27 << "' fill='#606060'>" << text(cell.previous_deg_h) << "</text>\n";
}

void draw(const std::vector<Cell>& cells, const std::string& path, double duration_s)
{
    std::ofstream svg(path);
    const int width = 2 * margin + static_cast<int>(frequencies_hz.size()) * cell_width;
    svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='"
        << 40 + static_cast<int>(half_angles_deg.size()) * panel_height
        << "' font-family='sans-serif' font-size='11' text-anchor='middle'>\n<rect width='100%' height='100%' fill='white'/>\n"
        << "<text x='" << width / 2 << "' y='18'>Coning drift over " << duration_s
        << " s from the first row on, deg/h: window-10 above, the 1/12 rule below.</text>\n"
        << "<text x='" << width / 2
        << "' y='34'>Pale: coning faster than a tenth of the sampling rate. Red border: worse than the 1/12 rule and above 1e-8.</text>\n";
    std::size_t next = 0;
    for (std::size_t panel = 0; panel < half_angles_deg.size(); ++panel) {
        const int top = 40 + static_cast<int>(panel) * panel_height + 44;
        svg << "<text x='" << margin << "' y='" << top - 24 << "' text-anchor='start' font-weight='bold'>half angle "
            << half_angles_deg[panel] << " deg</text>\n";
        for (std::size_t column = 0; column < frequencies_hz.size(); ++column)
            svg << "<text x='" << margin + static_cast<int>(column) * cell_width + cell_width / 2 << "' y='" << top - 6 << "'>"
                << frequencies_hz[column] << " Hz</text>\n";
        for (std::size_t row = 0; row < samplings_hz.size(); ++row) {
            const int y = top + static_cast<int>(row) * cell_height;
            svg << "<text x='" << margin - 6 << "' y='" << y + 20 << "' text-anchor='end'>" << samplings_hz[row] << " /s</text>\n";
            for (std::size_t column = 0; column < frequencies_hz.size(); ++column)
                draw_cell(svg, cells[next++], margin + static_cast<int>(column) * cell_width, y);
        }
    }
    svg << "</svg>\n";
}

int map(const std::string& path, double duration_s)
{
    const auto cells = sweep(duration_s);
    draw(cells, path, duration_s);
    int promised = 0;
    int broken = 0;
    int beyond_worse = 0;
    for (const Cell& cell : cells) {
        promised += cell.promised();
        broken += cell.promised() && cell.worse();
        beyond_worse += !cell.promised() && cell.worse();
    }
    std::printf(
        "%zu cells, %d with coning up to a tenth of the sampling rate: %d of them worse than the 1/12 rule and above 1e-8 deg/h;\n"
        "beyond a tenth: %d of %zu worse\n",
        cells.size(), promised, broken, beyond_worse, cells.size() - static_cast<std::size_t>(promised));
    return broken == 0 ? 0 : 1;
}

int table()
{
    struct Motion {
        const char* name;
        double half_angle_deg;
        double frequency_hz;
        double sampling_hz;
    };
    const std::array motions{Motion{"10deg 1Hz @100Hz", 10, 1, 100}, Motion{"10deg 2Hz @100", 10, 2, 100},
                             Motion{"10deg 5Hz @100", 10, 5, 100}, Motion{"60deg 1Hz @100", 60, 1, 100},
                             Motion{"1deg 50Hz @2kHz", 1, 50, 2000}};
    std::printf("| algorithm |");
    for (const auto& motion : motions) std::printf(" %s |", motion.name);
    std::printf("\n|---|---|---|---|---|---|\n");
    for (const char* algorithm : {"single", "previous", "two-sample", "three-sample", "three-sample-miller", "four-sample", "block-8",
                                  "window-8", "window-10", "window-12"}) {
        std::printf("| %s |", algorithm);
        for (const auto& m : motions)
            std::printf(" %.1e |",
                        deg_per_hour(error_after(algorithm, ClassicConing(m.half_angle_deg, m.frequency_hz), 1 / m.sampling_hz, 600), 600));
        std::printf("\n");
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() == 1 && arguments[0] == "table") return table();
    if (arguments.size() >= 2 && arguments.size() <= 3 && arguments[0] == "map") {
        const double duration_s = arguments.size() == 3 ? std::strtod(arguments[2].c_str(), nullptr) : 600;
        if (duration_s > 0) return map(arguments[1], duration_s);
    }
    std::fprintf(stderr, "usage: attitude_coning_map table | attitude_coning_map map FILE.svg [SECONDS]\n");
    return 2;
}
