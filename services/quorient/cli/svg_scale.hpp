#pragma once

#include <limits>
#include <string>
#include <vector>

namespace quorient::cli {

enum class Spacing { linear, logarithmic };

/// One axis of a diagram: from values to places in the drawing.
class Scale {
public:
    Scale(Spacing spacing, double from_place, double to_place) : spacing_(spacing), from_place_(from_place), to_place_(to_place) {}

    /// False for what the axis has no place for: not finite, or not above 0 on a logarithmic axis.
    bool shows(double value) const;

    /// The axis shall reach this value.
    void include(double value);

    /// After the last include(): widens the axis to round values, whole decades on a logarithmic axis, and chooses about `ticks` of them.
    void settle(double ticks);

    /// Values beyond the axis are shown at its end.
    double place(double value) const;

    std::vector<double> ticks() const;

private:
    double at(double value) const;

    Spacing spacing_;
    double from_place_;
    double to_place_;
    double lowest_ = std::numeric_limits<double>::infinity();
    double highest_ = -std::numeric_limits<double>::infinity();
    double step_ = 1;
};

/// 1, 2 or 5 times a power of ten, of which about `count` cover the span.
double round_step(double span, double count);

/// For text between the tags of HTML and SVG, and for their attributes.
std::string markup_escaped(const std::string& text);

}  // namespace quorient::cli
