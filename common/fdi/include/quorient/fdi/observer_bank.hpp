#pragma once

#include "quorient/fdi/noise.hpp"
#include "quorient/messages/limits.hpp"
#include "quorient/settings/setting.hpp"

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// Largest plant that an observer bank takes: so many states, so many outputs; inputs as many as a frame carries.
inline constexpr int max_states = 6;
inline constexpr int max_outputs = 6;
inline constexpr int max_inputs = 4;

using Poles = std::vector<std::complex<double>>;

/// x' = A x + B u,  y = C x + f: a plant and the sensors whose faults f are sought. [paper 001, eqs 8, 9]
struct LinearPlant {
    Eigen::MatrixXd a;  ///< n x n [1/s]
    Eigen::MatrixXd b;  ///< n x m
    Eigen::MatrixXd c;  ///< p x n

    Eigen::Index states() const { return a.rows(); }
    Eigen::Index inputs() const { return b.cols(); }
    Eigen::Index outputs() const { return c.rows(); }
};

/// @returns which matrix has the wrong size (with the one it should have), is not finite, or is larger than a bank takes.
tl::expected<void, std::string> check(const LinearPlant& plant);

/// The plant's own poles.
Poles poles_of(const Eigen::MatrixXd& matrix);

/// As an operator reads them: "-3, -1.5 +- 0.74i".
std::string to_string(const Poles& poles);

/// @returns that a pole is not in the left half plane, that complex poles do not come in conjugate pairs, or that there are not `count`.
tl::expected<void, std::string> check_poles(const Poles& poles, Eigen::Index count);

/// Directions of the state that outputs C can see, and those that they cannot. [Kalman's decomposition]
struct Observability {
    Eigen::MatrixXd seen;    ///< r x n, orthonormal rows
    Eigen::MatrixXd unseen;  ///< (n - r) x n, orthonormal rows
};

Observability observability(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c);

enum class ObserverScheme : std::uint8_t {
    directional,  ///< paper 001: observer i's error moves in one direction under a fault of channel i; two states, both measured
    blind,        ///< observer i ignores channel i: its other residuals stay 0 under a fault there; any linear plant
};

tl::expected<ObserverScheme, std::string> parse_observer_scheme(std::string_view word);
std::string_view to_string(ObserverScheme scheme);

struct ObserverSettings {
    LinearPlant plant;
    ObserverScheme scheme = ObserverScheme::blind;
    std::vector<Poles> poles;   ///< one set for each channel's observer, or one for all. directional: {along the fault, other}
    std::vector<double> sigma;  ///< noise of one sample of each channel, in its unit; one for all is enough; empty = 0
    double model_error = 0;
    double false_alarm_probability = default_false_alarm_probability;
    std::optional<double> threshold;
    double least_contrast = 1.5;
};

/// Its numbers, and what each means.
settings::Record<ObserverSettings> observer_record();

/// Bounds of one sample's standard deviation.
inline constexpr settings::Bounds sigma_bounds = settings::not_negative;

/// A number of observers that run side by side on the same samples: what each expects, and how far the samples are from it.
///
/// Observer:  xh' = (A - K C) xh + B u + K y,  r = y - C xh, with y and u held over an interval (exact discretisation).
/// For y = x + f the residual is r = C e + f, feedthrough included. [paper 001, eqs 10-12 corrected, docs/methods/observers.md]
///
/// Limit of a residual: z sigma_r + h/2 |dr/dh| + model_error * sum over the entries p of A and B of |dr/dp| |p|.
/// sigma_r is the residual's standard deviation, propagated from the start (noisy samples) to its stationary value, z the normal
/// quantile that shares the false-alarm probability among all residuals compared in one frame. A moving plant leaves residuals of the order
/// K x' h because samples are held (1e-5 in the paper's run at 100 Hz): dr/dh. The sensitivities run along with the observer, so the limit
/// breathes with the motion.
///
/// Not guaranteed: the model error counts to first order; a plant that is wrong in its structure raises alarms.
class ObserverBank {
public:
    using State = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_states, 1>;
    using Outputs = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_outputs, 1>;
    using Inputs = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_inputs, 1>;

    /// Observers: one per channel; for the blind scheme also one per pair of channels where the rest allows it.
    /// @returns what is wrong: matrix sizes, poles, a channel without which the plant is not detectable, gains whose directions or contrast
    ///          would name the wrong channel, no noise, model error or threshold to compare with.
    static tl::expected<ObserverBank, std::string> make(const ObserverSettings& settings, double interval_s);

    std::size_t size() const { return observers_.size(); }
    std::size_t channels() const { return static_cast<std::size_t>(plant_.outputs()); }
    std::size_t inputs() const { return static_cast<std::size_t>(plant_.inputs()); }
    ObserverScheme scheme() const { return scheme_; }

    /// The observer of these channels (directional: made for their fault; blind: without them).
    std::optional<std::size_t> find(AxisMask channels) const;

    const Eigen::MatrixXd& gain(std::size_t observer) const { return observers_[observer].gain; }
    Poles poles(std::size_t observer) const;

    /// All observers start from the state that the valid samples determine (least squares), or 0 where they do not.
    /// @returns the frames until a wrong start has decayed to 1/1000 in all observers; 0 where the samples determine the whole state.
    std::uint64_t start(const Outputs& samples, AxisMask valid);

    /// Compares the samples with what was expected of them. Channels that are not `valid` have residual 0.
    void compare(const Outputs& samples, AxisMask valid);

    /// Goes on by one interval with what was compared last and this input.
    void advance(const Inputs& input);

    const Outputs& residual(std::size_t observer) const { return observers_[observer].residual; }
    const Outputs& limit(std::size_t observer) const { return observers_[observer].limit; }

    /// C_i = |l_i' r_i| / |l_i| of eq (25), l_i = C K_i e_i, and its limit. Directional scheme.
    double metric(std::size_t observer) const;
    double metric_limit(std::size_t observer) const { return observers_[observer].metric_limit; }

    /// Directional scheme: frames after the onset of a constant fault during which the metrics may still name the wrong channel
    /// (at first every observer sees the bare fault; the directions form with the observers' poles), times 1.5. Blind scheme: 0.
    std::uint64_t attribution_frames() const { return attribution_frames_; }

private:
    static constexpr int max_parameters = max_states * (max_states + max_inputs) + 1;
    using StateMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_states, max_states>;
    using Sensitivity = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_states, max_parameters>;
    using OutputSensitivity = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_outputs, max_parameters>;

    using OutputMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_outputs, max_outputs>;
    using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_states, max_outputs>;

    struct Observer {
        AxisMask channels = 0;
        Eigen::MatrixXd gain;  ///< K, to be shown
        SmallMatrix correct;   ///< K, to be used: not on the heap, nor is anything made of it
        StateMatrix state;     ///< exp((A - K C) h)
        StateMatrix drive;     ///< integral of exp((A - K C) s) over the interval
        State estimate;        ///< xh
        Outputs residual;
        Outputs limit;
        Outputs noise_limit;      ///< z sigma_r
        StateMatrix covariance;   ///< the error's
        StateMatrix disturbance;  ///< what one interval of noise adds to it
        Outputs direction;        ///< l / |l|; directional
        double metric_noise_limit = 0;
        double metric_limit = 0;
        Sensitivity sensitivity;  ///< the error's: h/2 d/dh, then p d/dp for every entry of A and B that is not 0
    };

    /// One entry of A (column < n) or B that may be wrong.
    struct Parameter {
        Eigen::Index row = 0;
        Eigen::Index column = 0;
        double size = 0;
    };

    ObserverBank(const ObserverSettings& settings, double interval_s);
    tl::expected<void, std::string> design(const ObserverSettings& settings);
    tl::expected<void, std::string> design_directional(const ObserverSettings& settings);
    tl::expected<void, std::string> design_blind(const ObserverSettings& settings);
    void add(AxisMask channels, const Eigen::MatrixXd& gain);
    void set_noise(const ObserverSettings& settings);
    void set_noise_limits(Observer& observer) const;
    void set_attribution_frames();
    void set_limits(Observer& observer) const;
    void advance_sensitivity(Observer& observer, const Inputs& input) const;

    LinearPlant plant_;
    SmallMatrix a_, b_, c_;
    ObserverScheme scheme_;
    double interval_s_;
    double model_error_;
    std::optional<double> threshold_;
    double z_ = 0;
    Outputs variance_;                   ///< one sample's noise has it
    std::uint64_t settling_frames_ = 0;  ///< from a start that is wrong to 1/1000 of it, in all observers
    bool state_is_measured_ = false;     ///< the samples of all channels determine the whole state
    std::uint64_t attribution_frames_ = 0;
    SmallMatrix from_samples_;  ///< pseudo-inverse of C
    std::vector<Parameter> parameters_;
    std::vector<Observer> observers_;
};

}  // namespace quorient::fdi
