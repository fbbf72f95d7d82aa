#include "report/time_strip.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::cli {
namespace {

constexpr double file_width = 560;  // narrow, so that the letters stay readable where the file is shown small
constexpr double right_margin = 8;
constexpr double title_height = 20;
constexpr double legend_height = 13;
constexpr double bottom_margin = 30;
constexpr double height_of_tick = 24;
constexpr double bar_height = 16;
constexpr double bar_label_height = 14;
constexpr double letter_width = 6;

constexpr std::string_view file_style =
    "text{font:11px sans-serif;fill:#111}.g{stroke:#ddd;fill:none}.t{font-weight:bold}.l{fill:none;stroke-width:1.2}"
    ".b{fill-opacity:.45;stroke-width:.6}.o{paint-order:stroke;stroke:#fff;stroke-width:3px}.h{font-size:14px;font-weight:bold}";

double file_plot_width(double left)
{
    return file_width - left - right_margin;
}

/// From 0 at the left edge to 1 at the right one.
double share_of(const TimeSpan& span, double time_s)
{
    return std::clamp((time_s - span.from_s) / std::max(1e-9, span.to_s - span.from_s), 0.0, 1.0);
}

double percent_of(const TimeSpan& span, double time_s)
{
    return 100 * share_of(span, time_s);
}

std::string time_axis(const TimeSpan& span, double from, double base)
{
    std::string text;
    const double step = round_step(std::max(1e-9, span.to_s - span.from_s), span.most_ticks);
    for (double tick = std::ceil(span.from_s / step) * step; tick <= span.to_s + 1e-9; tick += step) {
        const double x = percent_of(span, tick);
        text += fmt::format(
            "<line x1='{0:.2f}%' x2='{0:.2f}%' y1='{1}' y2='{2:.1f}' class='g'/><text x='{0:.2f}%' y='{3:.1f}' text-anchor='middle'>{4:g}</text>\n",
            x, from, base, base + 13, std::abs(tick) < step / 1000 ? 0.0 : tick);
    }
    return text + fmt::format("<text x='100%' y='{:.1f}' text-anchor='end'>time, s</text>\n", base + 25);
}

/// In as many rows as have room in a file.
Strip strip_legend(const std::vector<Band>& bands, const TimeSpan& span)
{
    Strip made;
    double x = 0;
    for (const Band& band : bands) {
        if (band.name.empty()) continue;
        const double needed = 18 + letter_width * static_cast<double>(band.name.size());
        if (made.height == 0 || x + needed > file_plot_width(span.left)) {
            made.height += legend_height;
            x = 0;
        }
        made.body += fmt::format("<path d='M{0:.1f} {1}h14' stroke='{2}' stroke-width='3'{3}/><text x='{4:.1f}' y='{5}'>{6}</text>\n", x,
                                 made.height - 9, band.colour, band.dashed ? " stroke-dasharray='4 3'" : "", x + 18, made.height - 5,
                                 markup_escaped(band.name));
        x += needed + 12;
    }
    return made;
}

Scale scale_of(const std::vector<Band>& bands, const BandLook& look)
{
    Scale scale(look.spacing, look.height, 0);
    scale.include(0);
    for (const Band& band : bands)
        for (const Band::Point& point : band.points) {
            scale.include(point.least);
            scale.include(point.largest);
        }
    scale.settle(look.height / height_of_tick);
    return scale;
}

std::string value_axis(const Scale& scale, double from)
{
    std::string text;
    for (const double tick : scale.ticks())
        text += fmt::format("<line x1='0' x2='100%' y1='{0:.1f}' y2='{0:.1f}' class='g'/><text x='-4' y='{1:.1f}' text-anchor='end'>{2:g}</text>\n",
                            from + scale.place(tick), from + scale.place(tick) + 4, tick);
    return text;
}

/// One unbroken piece of a band: there along the largest values, back along the least.
std::string piece(const Band& band, std::size_t from, std::size_t to, const TimeSpan& span, const Scale& scale)
{
    std::string path;
    const auto place = [&](std::size_t i, double value) {
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', file_plot_width(span.left) * share_of(span, band.points[i].time_s),
                            scale.place(value));
    };
    for (std::size_t i = from; i < to; ++i) place(i, band.points[i].largest);
    const bool line = std::all_of(band.points.begin() + static_cast<std::ptrdiff_t>(from), band.points.begin() + static_cast<std::ptrdiff_t>(to),
                                  [](const Band::Point& p) { return p.least == p.largest; });
    if (line) return fmt::format("<path d='{}' stroke='{}' class='l'{}/>\n", path, band.colour, band.dashed ? " stroke-dasharray='4 3'" : "");
    for (std::size_t i = to; i > from; --i) place(i - 1, band.points[i - 1].least);
    return fmt::format("<path d='{}Z' fill='{}' stroke='{}' class='b'/>\n", path, band.colour, band.colour);
}

std::string drawn(const Band& band, const TimeSpan& span, const Scale& scale)
{
    std::string text;
    std::size_t from = 0;
    for (std::size_t i = 1; i <= band.points.size(); ++i) {
        const bool ends = i == band.points.size() || band.points[i].time_s - band.points[i - 1].time_s > band.longest_gap_s;
        if (!ends) continue;
        text += piece(band, from, i, span, scale);
        from = i;
    }
    return text;
}

/// Curves have no places in percent: a drawing within the drawing, which is stretched sideways to the width of the page.
std::string curves(const std::vector<Band>& bands, const TimeSpan& span, const Scale& scale, double from, double height)
{
    std::string text =
        fmt::format("<svg y='{0}' width='100%' height='{1}' viewBox='0 0 {2} {1}' preserveAspectRatio='none' overflow='visible'>\n", from,
                    height, file_plot_width(span.left));
    for (const Band& band : bands) text += drawn(band, span, scale);
    return text + "</svg>\n";
}

std::string bar(const TimeSpan& span, double y, double from_s, double to_s, const std::string& colour)
{
    const double least_percent = 0.4;  // so that the shortest one is seen
    const double from = std::min(percent_of(span, from_s), 100 - least_percent);
    return fmt::format("<rect x='{:.2f}%' y='{:.1f}' width='{:.2f}%' height='{}' fill='{}'/>\n", from, y + 2,
                       std::max(least_percent, percent_of(span, to_s) - from), bar_height - 4, colour);
}

}  // namespace

const std::string_view figure_style =
    "figure{margin:.8em 0;break-inside:avoid}figcaption{font-weight:bold;font-size:.9em;overflow-wrap:anywhere}figure svg{display:block;overflow:visible;"
    "font-size:12px;font-family:sans-serif}svg .g{stroke:#ddd;fill:none}svg .l{fill:none;stroke-width:1.2}svg .b{fill-opacity:.45;stroke-width:.6}"
    "svg path{vector-effect:non-scaling-stroke}svg .o{paint-order:stroke;stroke:#fff;stroke-width:3px}";

Strip band_strip(const std::string& title, const std::string& unit, const TimeSpan& span, const std::vector<Band>& bands, const BandLook& look)
{
    const Strip keys = strip_legend(bands, span);
    const double from = keys.height;
    const Scale scale = scale_of(bands, look);
    return {title, unit, span.left, from + look.height + bottom_margin,
            keys.body + time_axis(span, from, from + look.height) + value_axis(scale, from) + curves(bands, span, scale, from, look.height)};
}

Strip bar_strip(const std::string& title, const TimeSpan& span, const std::vector<Bar>& bars)
{
    const double base = (bar_label_height + bar_height) * static_cast<double>(bars.size());
    std::string text = time_axis(span, 0, base);
    double y = 0;
    for (const Bar& one : bars) {
        text += fmt::format("<text x='0' y='{:.1f}' class='o'>{}</text>\n", y + bar_label_height - 2, markup_escaped(one.label));
        text += bar(span, y + bar_label_height, one.from_s, one.to_s, one.colour);
        y += bar_label_height + bar_height;
    }
    return {title, {}, span.left, base + bottom_margin, text};
}

Strip row_strip(const std::string& title, const TimeSpan& span, const std::vector<BarRow>& rows)
{
    const double base = bar_height * static_cast<double>(rows.size());
    std::string text = time_axis(span, 0, base);
    double y = 0;
    for (const BarRow& row : rows) {
        text += fmt::format("<text x='-4' y='{:.1f}' text-anchor='end'>{}</text>\n", y + bar_height - 4, markup_escaped(row.label));
        for (const BarRow::Piece& one : row.pieces) {
            text += bar(span, y, one.from_s, one.to_s, one.colour);
            const double room = file_plot_width(span.left) * (share_of(span, one.to_s) - share_of(span, one.from_s));
            if (room > letter_width * static_cast<double>(one.text.size() + 2))
                text += fmt::format("<text x='{:.2f}%' dx='4' y='{:.1f}' class='o'>{}</text>\n", percent_of(span, one.from_s),
                                    y + bar_height - 4, markup_escaped(one.text));
        }
        y += bar_height;
    }
    return {title, {}, span.left, base + bottom_margin, text};
}

std::string figure_element(const Strip& strip)
{
    const std::string title = markup_escaped(strip.unit.empty() ? strip.title : fmt::format("{} [{}]", strip.title, strip.unit));
    return fmt::format("<figure><figcaption>{0}</figcaption>\n<svg xmlns='http://www.w3.org/2000/svg' role='img' aria-label='{0}' height='{1}' "
                       "style='margin:6px 0 0 {2}px;width:calc(100% - {3}px)'>\n{4}</svg></figure>\n",
                       title, strip.height, strip.left, strip.left + right_margin, strip.body);
}

std::string svg_file(const std::string& title, const std::vector<Strip>& strips)
{
    constexpr double header = 24;
    std::string body;
    double y = header;
    for (const Strip& strip : strips) {
        body += fmt::format("<text x='{}' y='{:.1f}' class='t'>{}</text><text x='{}' y='{:.1f}' text-anchor='end'>{}</text>\n", strip.left, y + 13,
                            markup_escaped(strip.title), strip.left - 6, y + 13, markup_escaped(strip.unit));
        y += title_height;
        body += fmt::format("<svg x='{}' y='{:.1f}' width='{}' height='{}' overflow='visible'>\n{}</svg>\n", strip.left, y,
                            file_plot_width(strip.left), strip.height, strip.body);
        y += strip.height;
    }
    return fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='840' viewBox='0 0 {0} {1:.1f}' role='img'>\n<title>{2}</title><style>{3}</style>\n"
        "<rect width='{0}' height='{1:.1f}' fill='#fff'/>\n<text x='8' y='18' class='h'>{2}</text>\n{4}</svg>\n",
        file_width, y, markup_escaped(title), file_style, body);
}

}  // namespace quorient::cli
