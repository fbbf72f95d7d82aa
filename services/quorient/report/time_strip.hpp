#pragma once

#include "cli/svg_scale.hpp"

#include <string>
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

/// A bar over a time, in a row of its own, with its label beside it.
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
    double left = 46;  ///< room for labels, in units of the drawing
};

/// A diagram over time, `height` units of the drawing high.
struct Strip {
    double height = 0;
    std::string body;
};

/// How a strip of bands is drawn.
struct BandLook {
    Spacing spacing = Spacing::linear;
    double height = 110;  ///< of the plot itself
};

Strip band_strip(const std::string& title, const std::string& unit, const TimeSpan& span, const std::vector<Band>& bands, const BandLook& look = {});
Strip bar_strip(const std::string& title, const TimeSpan& span, const std::vector<Bar>& bars);
Strip row_strip(const std::string& title, const TimeSpan& span, const std::vector<BarRow>& rows);

/// For a page of HTML, as wide as the page, which brings the style.
std::string svg_element(const Strip& strip);

/// All of them, one below the other, as an SVG file that needs nothing else.
std::string svg_file(const std::string& title, const std::vector<Strip>& strips);

}  // namespace quorient::cli
