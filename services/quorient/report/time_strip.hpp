#pragma once

#include "cli/svg_scale.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace quorient::cli {

/// One band of values over time: where least and largest are equal, a line.
struct Band {
    struct Point {
        double time_s = 0;
        double least = 0;
        double largest = 0;
    };
    std::string colour;
    std::vector<Point> points;
    bool dashed = false;
    double longest_gap_s = 0;  ///< points that are further apart are not joined
    std::string name = {};     ///< in the legend; empty = not there
};

/// A bar over a time, with its label in a line above it.
struct Bar {
    std::string label;
    std::string colour;
    double from_s = 0;
    double to_s = 0;
};

/// A row of bars with one label, in the margin.
struct BarRow {
    struct Piece {
        double from_s = 0;
        double to_s = 0;
        std::string colour;
        std::string text;  ///< within the bar, where there is room
    };
    std::string label;
    std::vector<Piece> pieces;
};

/// The time that all strips of a page show.
struct TimeSpan {
    double from_s = 0;
    double to_s = 1;
    double left = 46;  ///< room for labels, px
    int most_ticks = 7;
};

/// A diagram over time. Places across it are shares of its width, so that letters and heights keep their size [px] at any width.
struct Strip {
    std::string title;
    std::string unit;  ///< the values' unit; empty = none
    double left = 0;
    double height = 0;  ///< the body's
    std::string body;
};

/// How a strip of bands is drawn.
struct BandLook {
    Spacing spacing = Spacing::linear;
    double height = 110;  ///< the plot's own
};

Strip band_strip(const std::string& title, const std::string& unit, const TimeSpan& span, const std::vector<Band>& bands, const BandLook& look = {});
Strip bar_strip(const std::string& title, const TimeSpan& span, const std::vector<Bar>& bars);
Strip row_strip(const std::string& title, const TimeSpan& span, const std::vector<BarRow>& rows);

/// For a page of HTML, as wide as the page, with the title as a text of the page. `figure_style` belongs into the page's style.
std::string figure_element(const Strip& strip);
extern const std::string_view figure_style;

/// All of them, one below the other, as an SVG file that needs nothing else.
std::string svg_file(const std::string& title, const std::vector<Strip>& strips);

}  // namespace quorient::cli
