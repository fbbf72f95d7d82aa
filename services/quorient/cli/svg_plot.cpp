#include "svg_plot.hpp"

#include "svg_scale.hpp"

#include <fmt/format.h>
#include <array>

namespace quorient::cli {

namespace {

constexpr double plot_width = 900;
constexpr double plot_height = 420;  // one chart's
constexpr double plot_left = 80;
constexpr double plot_right = 210;  // the legend's room
constexpr double plot_top = 40;
constexpr double plot_bottom = 55;
constexpr double most_plot_ticks = 10;

std::string frame_and_ticks(const Chart& chart, const Scale& x, const Scale& y, double offset)
{
    const double base = offset + plot_height - plot_bottom;
    std::string text =
        fmt::format("<text x='{}' y='{:.1f}' font-size='15'>{}</text>\n", plot_left, offset + plot_top - 14, markup_escaped(chart.title));
    text += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", (plot_left + plot_width - plot_right) / 2, base + 40,
                        markup_escaped(chart.x_label));
    text += fmt::format("<text transform='translate(18,{:.1f}) rotate(-90)' text-anchor='middle'>{}</text>\n", (offset + plot_top + base) / 2,
                        markup_escaped(chart.y_label));
    for (const double tick : x.ticks()) {
        const double place = x.place(tick);
        text += fmt::format(
            "<path d='M{0:.1f} {1:.1f}V{2:.1f}' stroke='#ddd'/><text x='{0:.1f}' y='{3:.1f}' text-anchor='middle'>{4:g}</text>\n", place,
            offset + plot_top, base, base + 18, tick);
    }
    for (const double tick : y.ticks()) {
        const double place = y.place(tick);
        text +=
            fmt::format("<path d='M{1:.1f} {0:.1f}H{2:.1f}' stroke='#ddd'/><text x='{3:.1f}' y='{4:.1f}' text-anchor='end'>{5:g}</text>\n",
                        place, plot_left, plot_width - plot_right, plot_left - 6, place + 4, tick);
    }
    return text;
}

std::string drawn(const Series& series, const Scale& x, const Scale& y)
{
    std::string path;
    std::string marks;
    for (const auto& [px, py] : series.points) {
        if (!x.shows(px) || !y.shows(py)) continue;
        if (series.line) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', x.place(px), y.place(py));
        else marks += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='{}'/>\n", x.place(px), y.place(py), series.colour);
    }
    if (path.empty()) return marks;
    return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.3'/>\n", path, series.colour);
}

std::string plot_legend(const Chart& chart, double offset)
{
    std::string text;
    double row = offset + plot_top + 8;
    for (const Series& series : chart.series) {
        if (series.name.empty()) continue;
        text += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='14' height='4' fill='{}'/><text x='{:.1f}' y='{:.1f}'>{}</text>\n",
                            plot_width - plot_right + 12, row - 4, series.colour, plot_width - plot_right + 32, row + 2, markup_escaped(series.name));
        row += 15;
    }
    return text;
}

std::string draw(const Chart& chart, double offset)
{
    Scale x(chart.log_x ? Spacing::logarithmic : Spacing::linear, plot_left, plot_width - plot_right);
    Scale y(chart.log_y ? Spacing::logarithmic : Spacing::linear, offset + plot_height - plot_bottom, offset + plot_top);
    for (const Series& series : chart.series) {
        for (const auto& [px, py] : series.points) {
            if (!x.shows(px) || !y.shows(py)) continue;
            x.include(px);
            y.include(py);
        }
    }
    x.settle(most_plot_ticks);
    y.settle(most_plot_ticks);
    std::string text = frame_and_ticks(chart, x, y, offset);
    for (const Series& series : chart.series) text += drawn(series, x, y);
    return text + plot_legend(chart, offset);
}

}  // namespace

std::string colour(std::size_t number)
{
    constexpr std::array<const char*, 8> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a4d00", "#444444"};
    return colours[number % colours.size()];
}

std::string svg(const std::vector<Chart>& charts)
{
    const double total = plot_height * static_cast<double>(charts.size());
    std::string text = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' font-family='sans-serif' font-size='12'>\n"
        "<rect width='{0}' height='{1}' fill='white'/>\n",
        plot_width, total);
    for (std::size_t i = 0; i < charts.size(); ++i) text += draw(charts[i], plot_height * static_cast<double>(i));
    return text + "</svg>\n";
}

void write_svg(OutputFile& file, const std::vector<Chart>& charts)
{
    file.stream() << svg(charts);
    file.finish_document();
}

}  // namespace quorient::cli
