#include "report/time_strip.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::cli {
namespace {

// In units of the drawing: narrow, so that the letters stay readable on a phone.
constexpr double width = 560;
constexpr double left = 46;
constexpr double right = 8;
constexpr double top = 20;
constexpr double bottom = 30;
constexpr double band_height = 110;
constexpr double bar_height = 16;

double time_place(const TimeSpan& span, double time_s)
{
    const double share = (time_s - span.from_s) / std::max(1e-9, span.to_s - span.from_s);
    return left + std::clamp(share, 0.0, 1.0) * (width - left - right);
}

/// 1, 2 or 5 times a power of ten: about `count` of it cover the span.
double round_step(double span, double count)
{
    const double raw = std::max(span, 1e-9) / count;
    const double decade = std::pow(10, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (raw <= factor * decade) return factor * decade;
    return 10 * decade;
}

std::string time_axis(const TimeSpan& span, double base)
{
    std::string text;
    const double step = round_step(span.to_s - span.from_s, 7);
    for (double tick = std::ceil(span.from_s / step) * step; tick <= span.to_s + 1e-9; tick += step) {
        const double x = time_place(span, tick);
        text += fmt::format("<path d='M{0:.1f} {1}V{2:.1f}' class='g'/><text x='{0:.1f}' y='{3:.1f}' text-anchor='middle'>{4:g}</text>\n", x, top, base, base + 13,
                            std::abs(tick) < step / 1000 ? 0.0 : tick);
    }
    return text + fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>s</text>\n", width - right, base + 26);
}

std::string opened(const std::string& title, double height)
{
    return fmt::format("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' role='img'><text x='{}' y='13' class='t'>{}</text>\n", width, height, left,
                       html_escaped(title));
}

/// From value to place on the page.
struct ValueScale {
    double least;
    double largest;

    double place(double value) const { return top + band_height * (1 - (std::clamp(value, least, largest) - least) / (largest - least)); }
};

ValueScale scale_of(const std::vector<Band>& bands)
{
    double least = 0;
    double largest = 0;
    for (const Band& band : bands)
        for (const Band::Point& point : band.points) {
            if (std::isfinite(point.least)) least = std::min(least, point.least);
            if (std::isfinite(point.largest)) largest = std::max(largest, point.largest);
        }
    const double step = round_step(largest - least, 4);
    return {std::floor(least / step) * step, std::max(std::ceil(largest / step), std::floor(least / step) + 1) * step};
}

std::string value_axis(const ValueScale& scale, const std::string& unit)
{
    std::string text = fmt::format("<text x='{}' y='13' text-anchor='end'>{}</text>\n", left - 6, html_escaped(unit));
    const double step = round_step(scale.largest - scale.least, 4);
    for (double tick = scale.least; tick <= scale.largest + step / 2; tick += step)
        text += fmt::format("<path d='M{0} {1:.1f}H{2}' class='g'/><text x='{3}' y='{4:.1f}' text-anchor='end'>{5:g}</text>\n", left, scale.place(tick),
                            width - right, left - 4, scale.place(tick) + 4, std::abs(tick) < step / 1000 ? 0.0 : tick);
    return text;
}

/// One unbroken piece of a band: there along the largest values, back along the least.
std::string piece(const Band& band, std::size_t from, std::size_t to, const TimeSpan& span, const ValueScale& scale)
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

std::string drawn(const Band& band, const TimeSpan& span, const ValueScale& scale)
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

}  // namespace

std::string band_strip(const std::string& title, const std::string& unit, const TimeSpan& span, const std::vector<Band>& bands)
{
    const ValueScale scale = scale_of(bands);
    std::string text = opened(title, top + band_height + bottom) + time_axis(span, top + band_height) + value_axis(scale, unit);
    for (const Band& band : bands) text += drawn(band, span, scale);
    return text + "</svg>\n";
}

std::string bar_strip(const std::string& title, const TimeSpan& span, const std::vector<Bar>& bars)
{
    const double base = top + bar_height * static_cast<double>(bars.size());
    std::string text = opened(title, base + bottom) + time_axis(span, base);
    double y = top;
    for (const Bar& bar : bars) {
        const double from = time_place(span, bar.from_s);
        const double to = std::max(from + 2, time_place(span, bar.to_s));
        text += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{}' fill='{}'/>\n", from, y + 2, to - from, bar_height - 4, bar.colour);
        const bool leftwards = from > width / 2;
        text += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' class='o'>{}</text>\n", leftwards ? from - 4 : from + 4, y + bar_height - 4,
                            leftwards ? "end" : "start", html_escaped(bar.label));
        y += bar_height;
    }
    return text + "</svg>\n";
}

std::string html_escaped(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        if (c == '&') result += "&amp;";
        else if (c == '<') result += "&lt;";
        else if (c == '>') result += "&gt;";
        else if (c == '\'') result += "&#39;";
        else if (c == '"') result += "&quot;";
        else result += c;
    }
    return result;
}

}  // namespace quorient::cli
