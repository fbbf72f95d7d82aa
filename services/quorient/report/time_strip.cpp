#include "report/time_strip.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::cli {
namespace {

// In units of the drawing: narrow, so that the letters stay readable on a phone.
constexpr double width = 560;
constexpr double right = 8;
constexpr double top = 20;
constexpr double legend_height = 13;
constexpr double bottom = 30;
constexpr double height_of_tick = 24;
constexpr double bar_height = 16;
constexpr double letter_width = 6;

constexpr std::string_view file_style =
    "text{font:11px sans-serif;fill:#111}.g{stroke:#ddd;fill:none}.t{font-weight:bold}.l{fill:none;stroke-width:1.2}"
    ".b{fill-opacity:.45;stroke-width:.6}.o{paint-order:stroke;stroke:#fff;stroke-width:3px}.h{font-size:14px;font-weight:bold}";

double time_place(const TimeSpan& span, double time_s)
{
    const double share = (time_s - span.from_s) / std::max(1e-9, span.to_s - span.from_s);
    return span.left + std::clamp(share, 0.0, 1.0) * (width - span.left - right);
}

std::string time_axis(const TimeSpan& span, double from, double base)
{
    std::string text;
    const double step = round_step(std::max(1e-9, span.to_s - span.from_s), 7);
    for (double tick = std::ceil(span.from_s / step) * step; tick <= span.to_s + 1e-9; tick += step) {
        const double x = time_place(span, tick);
        text += fmt::format("<path d='M{0:.1f} {1}V{2:.1f}' class='g'/><text x='{0:.1f}' y='{3:.1f}' text-anchor='middle'>{4:g}</text>\n", x, from, base, base + 13,
                            std::abs(tick) < step / 1000 ? 0.0 : tick);
    }
    return text + fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>time, s</text>\n", width - right, base + 25);
}

std::string title_text(const std::string& title, const TimeSpan& span)
{
    return fmt::format("<text x='{}' y='13' class='t'>{}</text>\n", span.left, markup_escaped(title));
}

std::string legend(const std::vector<Band>& bands, const TimeSpan& span)
{
    std::string text;
    double x = span.left;
    for (const Band& band : bands) {
        if (band.name.empty()) continue;
        text += fmt::format("<path d='M{0:.1f} {1}h14' stroke='{2}' stroke-width='3'{3}/><text x='{4:.1f}' y='{5}'>{6}</text>\n", x, top + 4, band.colour,
                            band.dashed ? " stroke-dasharray='4 3'" : "", x + 18, top + 8, markup_escaped(band.name));
        x += 30 + letter_width * static_cast<double>(band.name.size());
    }
    return text;
}

Scale scale_of(const std::vector<Band>& bands, const BandLook& look, double from)
{
    Scale scale(look.spacing, from + look.height, from);
    scale.include(0);
    for (const Band& band : bands)
        for (const Band::Point& point : band.points) {
            scale.include(point.least);
            scale.include(point.largest);
        }
    scale.settle(look.height / height_of_tick);
    return scale;
}

std::string value_axis(const Scale& scale, const std::string& unit, const TimeSpan& span)
{
    std::string text = fmt::format("<text x='{}' y='13' text-anchor='end'>{}</text>\n", span.left - 6, markup_escaped(unit));
    for (const double tick : scale.ticks())
        text += fmt::format("<path d='M{0} {1:.1f}H{2}' class='g'/><text x='{3}' y='{4:.1f}' text-anchor='end'>{5:g}</text>\n", span.left, scale.place(tick),
                            width - right, span.left - 4, scale.place(tick) + 4, tick);
    return text;
}

/// One unbroken piece of a band: there along the largest values, back along the least.
std::string piece(const Band& band, std::size_t from, std::size_t to, const TimeSpan& span, const Scale& scale)
{
    std::string path;
    const auto place = [&](std::size_t i, double value) {
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', time_place(span, band.points[i].time_s), scale.place(value));
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

std::string bar(const TimeSpan& span, double y, double from_s, double to_s, const std::string& colour)
{
    const double from = time_place(span, from_s);
    const double to = std::max(from + 2, time_place(span, to_s));
    return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{}' fill='{}'/>\n", from, y + 2, to - from, bar_height - 4, colour);
}

}  // namespace

Strip band_strip(const std::string& title, const std::string& unit, const TimeSpan& span, const std::vector<Band>& bands, const BandLook& look)
{
    const std::string keys = legend(bands, span);
    const double from = top + (keys.empty() ? 0 : legend_height);
    const Scale scale = scale_of(bands, look, from);
    std::string text = title_text(title, span) + keys + time_axis(span, from, from + look.height) + value_axis(scale, unit, span);
    for (const Band& band : bands) text += drawn(band, span, scale);
    return {from + look.height + bottom, text};
}

Strip bar_strip(const std::string& title, const TimeSpan& span, const std::vector<Bar>& bars)
{
    const double base = top + bar_height * static_cast<double>(bars.size());
    std::string text = title_text(title, span) + time_axis(span, top, base);
    double y = top;
    for (const Bar& one : bars) {
        text += bar(span, y, one.from_s, one.to_s, one.colour);
        const double from = time_place(span, one.from_s);
        const bool leftwards = from > width / 2;
        text += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' class='o'>{}</text>\n", leftwards ? from - 4 : from + 4, y + bar_height - 4,
                            leftwards ? "end" : "start", markup_escaped(one.label));
        y += bar_height;
    }
    return {base + bottom, text};
}

Strip row_strip(const std::string& title, const TimeSpan& span, const std::vector<BarRow>& rows)
{
    const double base = top + bar_height * static_cast<double>(rows.size());
    std::string text = title_text(title, span) + time_axis(span, top, base);
    double y = top;
    for (const BarRow& row : rows) {
        text += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>{}</text>\n", span.left - 4, y + bar_height - 4, markup_escaped(row.label));
        for (const BarRow::Piece& one : row.pieces) {
            text += bar(span, y, one.from_s, one.to_s, one.colour);
            const double room = time_place(span, one.to_s) - time_place(span, one.from_s);
            if (room > letter_width * static_cast<double>(one.text.size() + 2))
                text += fmt::format("<text x='{:.1f}' y='{:.1f}' class='o'>{}</text>\n", time_place(span, one.from_s) + 4, y + bar_height - 4, markup_escaped(one.text));
        }
        y += bar_height;
    }
    return {base + bottom, text};
}

std::string svg_element(const Strip& strip)
{
    return fmt::format("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' role='img'>{}</svg>\n", width, strip.height, strip.body);
}

std::string svg_file(const std::string& title, const std::vector<Strip>& strips)
{
    constexpr double header = 24;
    std::string body;
    double y = header;
    for (const Strip& strip : strips) {
        body += fmt::format("<g transform='translate(0,{:.1f})'>\n{}</g>\n", y, strip.body);
        y += strip.height;
    }
    return fmt::format("<svg xmlns='http://www.w3.org/2000/svg' width='840' viewBox='0 0 {0} {1:.1f}' role='img'>\n<title>{2}</title><style>{3}</style>\n"
                       "<rect width='{0}' height='{1:.1f}' fill='#fff'/>\n<text x='8' y='18' class='h'>{2}</text>\n{4}</svg>\n",
                       width, y, markup_escaped(title), file_style, body);
}

}  // namespace quorient::cli
