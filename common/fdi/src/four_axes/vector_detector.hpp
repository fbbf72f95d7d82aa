#pragma once

#include "four_axes/four_axis_detector.hpp"

#include <memory>
#include <optional>

namespace quorient::fdi {

/// Extrapolates the body *vector* (not its modulus, so no direction is blind) and takes the triad that lies nearest to it.
/// [docs/methods/four_axes.md, vector predictor; the nearest triad leaves out the largest innovation |z_j - h_j theta_pred|]
///
/// The predictor is a least-squares polynomial over the newest frames of the history; its order (1 to 3) and length are chosen by
/// trial: every candidate predicts, over the same horizon, frames of the history that are already known, and the one with the
/// smallest rms error predicts. A slow turn is thus followed by long smooth fits, a fast one by short curved ones, and that rms is
/// the prediction's standard deviation.
///
/// A fault may have begun before it crossed the bound, and its beginning would be extrapolated as if it were motion. At the first
/// suspicious frame the history is therefore cut back to where the sums of the parity over several windows are those of noise and
/// carried quantisation; the cut is also the onset that is reported. From then on the history is held and the horizon grows.
///
/// A triad is refuted by its worst frame since the fault was seen: by the largest of its distances, each in standard deviations of
/// its own prediction. Isolated where every other triad is refuted by settings.margin (default 3) more of them than the best one,
/// and by at least twice as many; else those not refuted are the candidates.
class VectorDetector final : public FourAxisDetector {
public:
    static constexpr std::size_t history_length = 2048;

    static tl::expected<std::unique_ptr<VectorDetector>, std::string> make(const DetectorSettings& settings,
                                                                            const geometry::SensorCluster& cluster);

    struct Prediction {
        Eigen::Vector3d body = Eigen::Vector3d::Zero();  ///< [unit of z]
        double sigma = 0;                                ///< rms length of the error of such predictions [unit of z]
        unsigned order = 0;
    };

    /// For the newest complete frame; nullptr while fewer than four frames are known.
    const Prediction* prediction() const { return prediction_ ? &*prediction_ : nullptr; }
    const std::array<double, axis_count>& triad_distance() const { return distance_; }  ///< T1..T4, |theta^(k) - theta_pred|
    /// Index of the triad nearest to the prediction; meaningless without one.
    std::size_t working_triad() const { return working_triad_; }

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    /// One candidate: a polynomial of this order over this many frames.
    struct Polynomial {
        std::size_t order;
        std::size_t length;
    };

    static constexpr std::array<Polynomial, 15> polynomials{{{1, 3},
                                                             {2, 3},
                                                             {3, 4},
                                                             {1, 8},
                                                             {2, 8},
                                                             {3, 8},
                                                             {1, 16},
                                                             {2, 16},
                                                             {3, 16},
                                                             {2, 48},
                                                             {3, 48},
                                                             {2, 128},
                                                             {3, 128},
                                                             {2, 320},
                                                             {3, 320}}};
    static constexpr std::size_t tried_every_frame = 9;  ///< the first of them: the long ones only help over long horizons
    static constexpr std::size_t longest = 320;

    VectorDetector(const Geometry& made, double margin);

    void observe(const Frame& frame) override;
    void learn(const Frame& frame) override;
    void attribute(const Frame& frame, Assessment& assessment) override;
    void forget() override;
    unsigned learnt() const override { return static_cast<unsigned>(size_); }
    bool predicts_over_gaps() const override { return true; }

    const Eigen::Vector3d& past(std::size_t age) const { return body_[(next_ + history_length - 1 - age) % history_length]; }
    double parity_sum(std::size_t from_age, std::size_t frames) const;
    std::size_t contaminated_frames() const;
    Eigen::Vector3d extrapolate(std::span<const double> weights, std::size_t newest_age) const;
    std::optional<Prediction> predict(const Polynomial& polynomial, std::size_t horizon) const;
    std::optional<Prediction> predict_one_frame() const;
    std::optional<Prediction> predict_from_cut(unsigned horizon) const;
    void compare(const Frame& frame);
    void name_unrefuted(Assessment& assessment) const;

    double margin_;
    double parity_sigma_;
    double parity_quantum_;
    double triad_sigma_;  ///< rms length of the error of one triad's body vector by noise and quantisation [unit of z]
    std::array<std::array<double, longest>, tried_every_frame> weights_{};  ///< for the one-frame predictions
    std::array<Eigen::Vector3d, tried_every_frame> one_frame_;
    std::array<double, tried_every_frame> error_{};  ///< squared, forgetting
    std::array<Eigen::Vector3d, history_length> body_;
    std::array<double, history_length> parity_total_{};  ///< running sum up to each frame
    double parity_running_ = 0;
    std::size_t size_ = 0;
    std::size_t next_ = 0;
    std::size_t cut_ = 0;  ///< frames of the held history that may be contaminated
    bool held_ = false;
    std::optional<Prediction> prediction_;
    std::array<double, axis_count> distance_{};
    std::array<double, axis_count> refutation_{};  ///< largest distance since the fault was seen, in standard deviations
    std::size_t working_triad_ = 0;
};

}  // namespace quorient::fdi
