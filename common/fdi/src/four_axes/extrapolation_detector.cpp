#include "four_axes/extrapolation_detector.hpp"

#include <algorithm>
#include <limits>

namespace quorient::fdi {

namespace {

/// About so many errors of predictions count.
constexpr unsigned remembered_errors = 16;
constexpr double missed_sigmas = 3;

}  // namespace

std::string_view name(ModulusFallback fallback)
{
    switch (fallback) {
        case ModulusFallback::none:
            return "none";
        case ModulusFallback::mean:
            return "mean";
        case ModulusFallback::line:
            return "line";
        case ModulusFallback::quadratic:
            return "quadratic";
    }
    return "unknown";
}

namespace {

void fall_back(const std::array<double, 4>& moduli, double resolution, ModulusPrediction& prediction)
{
    const auto& [a, b, c, d] = moduli;
    const auto [low, high] = std::minmax_element(moduli.begin(), moduli.end());
    const double agreement = 4 * resolution;
    if (*high - *low <= agreement) {
        prediction.fallback = ModulusFallback::mean;
        prediction.predicted = (a + b + c + d) / 4;
    } else if (std::abs(a - 2 * b + c) <= agreement && std::abs(b - 2 * c + d) <= agreement) {
        prediction.fallback = ModulusFallback::line;
        prediction.predicted = -a / 2 + c / 2 + d;
    } else {
        prediction.fallback = ModulusFallback::quadratic;
        prediction.predicted = 3 * d - 3 * c + b;
    }
}

}  // namespace

ModulusPrediction predict_modulus(const std::array<double, 4>& moduli, double resolution)
{
    // det is a difference of two products of moduli that are themselves rounded: below this it is rounding alone.
    constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

    const auto& [a, b, c, d] = moduli;
    ModulusPrediction prediction;
    prediction.determinant = b * b - a * c;
    if (std::abs(prediction.determinant) <= rounding * (b * b + std::abs(a * c))) {
        fall_back(moduli, resolution, prediction);
        return prediction;
    }
    prediction.z1 = (c * c - b * d) / prediction.determinant;
    prediction.z2 = (a * d - b * c) / prediction.determinant;
    prediction.predicted = -c * prediction.z1 - d * prediction.z2;
    return prediction;
}

double prediction_uncertainty(const std::array<double, 4>& moduli, double resolution)
{
    const double predicted = predict_modulus(moduli, resolution).predicted;
    double squares = 0;
    for (std::size_t k = 0; k < moduli.size(); ++k) {
        double moved = 0;
        for (const double step : {-resolution, resolution}) {
            auto other = moduli;
            other[k] += step;
            moved = std::max(moved, std::abs(predict_modulus(other, resolution).predicted - predicted));
        }
        squares += moved * moved;
    }
    return std::sqrt(squares);
}

tl::expected<std::unique_ptr<ExtrapolationDetector>, std::string> ExtrapolationDetector::make(const DetectorSettings& settings,
                                                                                              const geometry::SensorCluster& cluster)
{
    const auto made = geometry_of(settings, cluster, "extrapolation");
    if (!made) return tl::unexpected(made.error());
    return std::unique_ptr<ExtrapolationDetector>(new ExtrapolationDetector(*made, settings.margin.value_or(made->bound)));
}

void ExtrapolationDetector::observe(const Frame& frame)
{
    for (std::size_t k = 0; k < axis_count; ++k) triad_modulus_[k] = frame.triad_body[k].norm();
    predicted_ = learnt_ == modulus_.size();
    if (!predicted_) return;
    observed_ = frame.identity;
    prediction_ = predict_modulus(modulus_, resolution());
    uncertainty_ = prediction_uncertainty(modulus_, resolution() / 2);  // what rounding takes at most
    working_triad_ = 0;
    for (std::size_t k = 1; k < axis_count; ++k)
        if (distance(k) < distance(working_triad_)) working_triad_ = k;
}

void ExtrapolationDetector::forget()
{
    learnt_ = 0;
    missed_ = 0;
    measured_ = 0;
    observed_ = {};  // a prediction that was held is no measure of the next ones
}

void ExtrapolationDetector::learn(const Frame& frame)
{
    if (predicted_ && observed_ == frame.identity) {
        const double missed = std::max(0.0, std::abs(prediction_.predicted - frame.body.norm()) - uncertainty_);
        measured_ = std::min(measured_ + 1, remembered_errors);
        missed_ += (missed * missed - missed_) / measured_;
    }
    std::shift_left(modulus_.begin(), modulus_.end(), 1);
    modulus_.back() = frame.body.norm();
    learnt_ = std::min<unsigned>(learnt_ + 1, static_cast<unsigned>(modulus_.size()));
}

/// What a triad's modulus may differ by from the prediction that is held for so many frames: a smooth motion leaves it with their square.
double ExtrapolationDetector::allowance(unsigned horizon) const
{
    const double moved = std::abs(modulus_[3] - modulus_[2]) * (horizon - 1);
    return margin_ + uncertainty_ + missed_sigmas * std::sqrt(missed_) * horizon * horizon + moved;
}

void ExtrapolationDetector::attribute(const Frame& frame, Assessment& assessment)
{
    assessment.outcome = Outcome::isolated;
    assessment.isolated = left_out_by(working_triad_);
    assessment.add_candidate(assessment.isolated);
    for (std::size_t k = 0; k < axis_count; ++k) {
        if (k == working_triad_ || distance(k) - distance(working_triad_) > allowance(frame.horizon)) continue;
        assessment.add_candidate(left_out_by(k));
        assessment.outcome = Outcome::ambiguous;
    }
    if (assessment.outcome == Outcome::ambiguous) assessment.isolated = 0;
}

std::vector<Detail> ExtrapolationDetector::details(const Assessment&) const
{
    const std::vector<double> moduli(triad_modulus_.begin(), triad_modulus_.end());
    if (!predicted_)
        return {{"predicted", {}}, {"triad_modulus", moduli}, {"working_triad", {}}, {"z1", {}}, {"z2", {}}, {"determinant", {}}, {"fallback", {}}};
    return {{"predicted", prediction_.predicted},
            {"triad_modulus", moduli},
            {"working_triad", Detail::Axes{triad(working_triad_).mask()}},
            {"z1", prediction_.z1},
            {"z2", prediction_.z2},
            {"determinant", prediction_.determinant},
            {"fallback", std::string(name(prediction_.fallback))}};
}

}  // namespace quorient::fdi
