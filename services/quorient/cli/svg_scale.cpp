#include "svg_scale.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::cli {

namespace {

constexpr double most_decades = 5;  // on a logarithmic scale: what lies below stands at its foot

}  // namespace

bool Scale::shows(double value) const
{
    return std::isfinite(value) && (spacing_ == Spacing::linear || value > 0);
}

void Scale::include(double value)
{
    if (!shows(value)) return;
    lowest_ = std::min(lowest_, at(value));
    highest_ = std::max(highest_, at(value));
}

void Scale::settle(double ticks)
{
    if (lowest_ > highest_) lowest_ = highest_ = 0;
    if (spacing_ == Spacing::logarithmic) lowest_ = std::max(lowest_, highest_ - most_decades);
    const double span = highest_ > lowest_ ? highest_ - lowest_ : 1.0;
    step_ = spacing_ == Spacing::logarithmic ? std::max(1.0, std::ceil(span / ticks)) : round_step(span, ticks);
    lowest_ = std::floor(lowest_ / step_ + 1e-9) * step_;
    highest_ = std::max(lowest_ + step_, std::ceil(highest_ / step_ - 1e-9) * step_);
}

double Scale::place(double value) const
{
    const double share = (at(value) - lowest_) / (highest_ - lowest_);
    return from_place_ + std::clamp(share, 0.0, 1.0) * (to_place_ - from_place_);
}

std::vector<double> Scale::ticks() const
{
    std::vector<double> values;
    const auto count = std::lround((highest_ - lowest_) / step_);
    for (long i = 0; i <= count; ++i) {
        const double position = lowest_ + static_cast<double>(i) * step_;
        if (spacing_ == Spacing::logarithmic) values.push_back(std::pow(10.0, position));
        else values.push_back(std::abs(position) < step_ / 1000 ? 0.0 : position);
    }
    return values;
}

double Scale::at(double value) const
{
    if (spacing_ == Spacing::linear) return value;
    return value > 0 ? std::log10(value) : -std::numeric_limits<double>::infinity();
}

double round_step(double span, double count)
{
    const double raw = std::max(span, 1e-300) / count;
    const double decade = std::pow(10, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (raw <= factor * decade) return factor * decade;
    return 10 * decade;
}

std::string markup_escaped(const std::string& text)
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
