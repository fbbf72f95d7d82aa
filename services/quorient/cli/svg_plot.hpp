#pragma once

#include "output_file.hpp"

#include <string>
#include <utility>
#include <vector>

namespace quorient::cli {

/// One set of points of a chart.
struct Series {
    std::string name;  ///< in the legend; empty = not there
    std::vector<std::pair<double, double>> points;
    std::string colour;
    bool line = true;  ///< joined by a line, else marked one by one
};

/// One diagram. Points that an axis cannot show (not finite; not above 0 on a logarithmic axis) are left out.
struct Chart {
    std::string title;
    std::string x_label;
    std::string y_label;
    bool log_x = false;
    bool log_y = false;
    std::vector<Series> series;
};

/// A colour that differs from its neighbours' in number.
std::string colour(std::size_t number);

/// The charts, one below the other, as an SVG file that stands for itself.
std::string svg(const std::vector<Chart>& charts);

/// Writes it, or ends the verb with the reason.
void write_svg(OutputFile& file, const std::vector<Chart>& charts);

}  // namespace quorient::cli
