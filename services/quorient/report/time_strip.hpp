#pragma once

#include <optional>
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
};

/// A bar over a time, in a row of its own.
struct Bar {
    std::string label;
    std::string colour;
    double from_s = 0;
    double to_s = 0;
};

/// The time that all strips of a page show.
struct TimeSpan {
    double from_s = 0;
    double to_s = 1;
};

/// A diagram over time as an SVG element that scales to the width of the page.
std::string band_strip(const std::string& title, const std::string& unit, const TimeSpan& span, const std::vector<Band>& bands);
std::string bar_strip(const std::string& title, const TimeSpan& span, const std::vector<Bar>& bars);

/// For text between HTML tags.
std::string html_escaped(const std::string& text);

}  // namespace quorient::cli
