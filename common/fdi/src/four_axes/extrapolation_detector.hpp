#pragma once

#include "four_axes/four_axis_detector.hpp"

#include <cmath>
#include <memory>
#include <string_view>

namespace quorient::fdi {

/// What stands in for the exponential predictor where it has no solution.
enum class ModulusFallback : std::uint8_t {
    none,
    mean,       ///< the four moduli agree within four quanta: their mean
    line,       ///< both second differences are within four quanta: the least-squares line
    quadratic,  ///< else the quadratic through the last three
};

std::string_view name(ModulusFallback fallback);

/// theta** and the coefficients it came from.
struct ModulusPrediction {
    double predicted = 0;
    double z1 = 0;
    double z2 = 0;
    double determinant = 0;  ///< theta_{n-3}^2 - theta_{n-4} theta_{n-2}
    ModulusFallback fallback = ModulusFallback::none;
};

/// The modulus of the body vector at frame n from those at n-4 .. n-1, as a sum of two exponentials (Prony). [paper 003, eqs 43-45]
///   z1 = (c^2 - b d) / det,  z2 = (a d - b c) / det,  det = b^2 - a c,  theta** = -c z1 - d z2    for moduli (a, b, c, d).
///
/// Exact for sums of two real exponentials. Ill-conditioned where the modulus hardly changes: det is then the quantiser's noise and
/// the error reaches hundreds of quanta. Where det is within the rounding of its own terms there is no solution: z1 = z2 = 0 and
/// the fallback, which is named, predicts.
/// @param resolution  one quantum [unit of the moduli]; only the fallback asks.
ModulusPrediction predict_modulus(const std::array<double, 4>& moduli, double resolution);

/// How far the prediction moves when each modulus in turn is off by one resolution, root of the sum of squares: where the determinant
/// is small this is hundreds of quanta.
double prediction_uncertainty(const std::array<double, 4>& moduli, double resolution);

/// The paper's method: the working triad is the one whose modulus lies nearest to the predicted one.
///
/// In the pipeline the parity scalar decides whether there is a fault at all, and the prediction from before the fault is held
/// while the fault lasts (fed back on itself it diverges). Known weakness, kept because it is the paper's: faults that turn
/// the vector without changing its length are invisible, and a nearly constant modulus makes the prediction noise. Where the next
/// triad is nearer than settings.margin [unit of z] to the best, both axes are candidates; the default margin is what the bound
/// lets a healthy modulus differ by. To it comes the uncertainty of the prediction itself, which the paper does not ask for: without
/// it 34 of 1400 soft faults (x 0.8) at random times of the paper's motion named a healthy axis within six frames, with it none. To it
/// also come what the predictions of the last healthy frames missed beyond their uncertainty, times the square of the frames for which the
/// prediction is held, and how far the modulus moves meanwhile: not every motion is a sum of two exponentials. 672 in place of 1017 are named in
/// that time, the others are ambiguous first.
class ExtrapolationDetector final : public FourAxisDetector {
public:
    static tl::expected<std::unique_ptr<ExtrapolationDetector>, std::string> make(const DetectorSettings& settings,
                                                                                  const geometry::SensorCluster& cluster);

    /// The prediction for the newest complete frame; nullptr while fewer than four moduli are known.
    const ModulusPrediction* prediction() const { return predicted_ ? &prediction_ : nullptr; }
    const std::array<double, axis_count>& triad_modulus() const { return triad_modulus_; }  ///< T1..T4 [unit of z]
    /// Index of the triad nearest to the prediction; meaningless without one.
    std::size_t working_triad() const { return working_triad_; }

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    ExtrapolationDetector(const Geometry& made, double margin) : FourAxisDetector(made), margin_(margin) {}

    void observe(const Frame& frame) override;
    void learn(const Frame& frame) override;
    void attribute(const Frame& frame, Assessment& assessment) override;
    void forget() override;
    unsigned learnt() const override { return learnt_; }
    bool predicts_over_gaps() const override { return false; }
    double allowance(unsigned horizon) const;
    double distance(std::size_t triad) const { return std::abs(prediction_.predicted - triad_modulus_[triad]); }

    double margin_;
    std::array<double, 4> modulus_{};  ///< oldest first
    unsigned learnt_ = 0;
    bool predicted_ = false;
    ModulusPrediction prediction_;
    double uncertainty_ = 0;  ///< the prediction's
    Identity observed_;       ///< the frame that it is for
    unsigned measured_ = 0;   ///< predictions that were compared
    double missed_ = 0;       ///< mean square of what predictions missed beyond their uncertainty
    std::array<double, axis_count> triad_modulus_{};
    std::size_t working_triad_ = 0;
};

}  // namespace quorient::fdi
