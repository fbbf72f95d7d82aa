#include "quorient/fdi/observer_bank.hpp"

#include "observers/observer_design.hpp"
#include "quorient/geometry/zero_order_hold.hpp"

#include <fmt/format.h>
#include <Eigen/QR>
#include <array>
#include <bit>
#include <cmath>

namespace quorient::fdi {
namespace {

/// "Decayed to nothing": below any threshold that is worth setting.
constexpr double settled = 1e-3;

double slowest_rate(const Eigen::MatrixXd& matrix)
{
    double rate = std::numeric_limits<double>::infinity();
    for (const auto& pole : poles_of(matrix)) rate = std::min(rate, -pole.real());
    return rate;
}

tl::expected<void, std::string> check_settings(const ObserverSettings& settings, double interval_s)
{
    if (auto checked = check(settings.plant); !checked) return checked;
    const auto channels = static_cast<std::size_t>(settings.plant.outputs());
    if (!(interval_s > 0) || !std::isfinite(interval_s))
        return tl::unexpected(fmt::format("the interval must be above 0 s, got {}", interval_s));
    if (settings.poles.size() != 1 && settings.poles.size() != channels)
        return tl::unexpected(
            fmt::format("observer poles: one set, or one for each of the {} channels, got {}", channels, settings.poles.size()));
    if (settings.sigma.size() > 1 && settings.sigma.size() != channels)
        return tl::unexpected(
            fmt::format("sigma: one figure, or one for each of the {} channels, got {}", channels, settings.sigma.size()));
    bool noisy = false;
    for (const double sigma : settings.sigma) {
        if (!sigma_bounds.hold(sigma)) return tl::unexpected(settings::out_of_bounds("sigma", sigma_bounds, "", sigma));
        noisy = noisy || sigma > 0;
    }
    if (const auto bounded = settings::check(observer_record(), settings); !bounded) return bounded;
    if (!settings.threshold && !noisy)
        return tl::unexpected(std::string("nothing to compare residuals with: give a threshold, or the sigma of the channels"));
    return {};
}

double sigma_of(const ObserverSettings& settings, std::size_t channel)
{
    if (settings.sigma.empty()) return 0;
    return settings.sigma[settings.sigma.size() == 1 ? 0 : channel];
}

}  // namespace

settings::Record<ObserverSettings> observer_record()
{
    static constexpr std::array<settings::Setting<ObserverSettings>, 4> record{{
        {"model_error",
         &ObserverSettings::model_error,
         "",
         {.lowest = 0, .highest = 1, .highest_included = false},
         "Bound of the relative error of every entry of the plant's matrices A and B."},
        {"pfa", &ObserverSettings::false_alarm_probability, "", settings::probability, "Probability of a false alarm in one frame."},
        {"threshold", &ObserverSettings::threshold, "", settings::above_zero, "Limit of every residual and metric, in the channels' unit.",
         "from noise and model error"},
        {"least_contrast",
         &ObserverSettings::least_contrast,
         "",
         {.lowest = 1},
         "`directional`: poles are refused unless the right metric exceeds the wrong one so many times."},
    }};
    return record;
}

tl::expected<ObserverScheme, std::string> parse_observer_scheme(std::string_view word)
{
    if (word == "directional") return ObserverScheme::directional;
    if (word == "blind") return ObserverScheme::blind;
    return tl::unexpected(fmt::format("unknown scheme '{}'; there are directional and blind", word));
}

std::string_view to_string(ObserverScheme scheme)
{
    return scheme == ObserverScheme::directional ? "directional" : "blind";
}

tl::expected<ObserverBank, std::string> ObserverBank::make(const ObserverSettings& settings, double interval_s)
{
    if (auto checked = check_settings(settings, interval_s); !checked) return tl::unexpected(checked.error());
    ObserverBank bank(settings, interval_s);
    if (auto designed = bank.design(settings); !designed) return tl::unexpected(designed.error());
    bank.set_noise(settings);
    if (settings.scheme == ObserverScheme::directional) bank.set_attribution_frames();
    return bank;
}

ObserverBank::ObserverBank(const ObserverSettings& settings, double interval_s)
    : plant_(settings.plant),
      a_(settings.plant.a),
      b_(settings.plant.b),
      c_(settings.plant.c),
      scheme_(settings.scheme),
      interval_s_(interval_s),
      model_error_(settings.threshold ? 0 : settings.model_error),
      threshold_(settings.threshold),
      from_samples_(settings.plant.c.completeOrthogonalDecomposition().pseudoInverse())
{
    Eigen::MatrixXd both(plant_.states(), plant_.states() + plant_.inputs());
    both << plant_.a, plant_.b;
    for (Eigen::Index row = 0; row < both.rows(); ++row) {
        for (Eigen::Index column = 0; column < both.cols(); ++column) {
            if (model_error_ > 0 && both(row, column) != 0) parameters_.push_back({row, column, both(row, column)});
        }
    }
}

tl::expected<void, std::string> ObserverBank::design(const ObserverSettings& settings)
{
    auto designed = scheme_ == ObserverScheme::directional ? design_directional(settings) : design_blind(settings);
    if (!designed) return designed;
    state_is_measured_ = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(plant_.c).rank() == plant_.states();
    for (const Observer& observer : observers_) {
        const double rate = slowest_rate(plant_.a - observer.gain * plant_.c);
        settling_frames_ = std::max(settling_frames_, static_cast<std::uint64_t>(std::ceil(-std::log(settled) / rate / interval_s_)));
    }
    return {};
}

tl::expected<void, std::string> ObserverBank::design_directional(const ObserverSettings& settings)
{
    if (plant_.states() != 2 || !plant_.c.isApprox(Eigen::MatrixXd::Identity(plant_.outputs(), 2)))
        return tl::unexpected(
            std::string("the directional scheme needs two states, both measured (C = I); the blind scheme takes any plant"));
    std::vector<Eigen::MatrixXd> gains;
    for (std::size_t channel = 0; channel < 2; ++channel) {
        const Poles& poles = settings.poles[settings.poles.size() == 1 ? 0 : channel];
        if (auto checked = check_poles(poles, 2); !checked) return checked;
        if (poles[0].imag() != 0) return tl::unexpected(std::string("the directional scheme needs real poles"));
        const auto gain = directional_gain(plant_.a, static_cast<Eigen::Index>(channel), poles[0].real(), poles[1].real());
        if (!gain) return tl::unexpected(gain.error());
        gains.emplace_back(*gain);
    }
    if (auto checked = check_conditions(plant_.a, gains); !checked) return checked;
    const auto contrasts = contrast(plant_, gains);
    for (std::size_t channel = 0; channel < 2; ++channel) {
        if (contrasts[channel] >= settings.least_contrast) continue;
        return tl::unexpected(
            fmt::format("these poles would name the wrong channel: while a fault of channel {} lasts, its own metric is {:.3g} times the "
                        "other one's, and {:.3g} "
                        "is needed; choose other poles, or the blind scheme",
                        channel, contrasts[channel], settings.least_contrast));
    }
    for (std::size_t channel = 0; channel < 2; ++channel) add(axis_bit(channel), gains[channel]);
    return {};
}

tl::expected<void, std::string> ObserverBank::design_blind(const ObserverSettings& settings)
{
    if (channels() < 2) return tl::unexpected(std::string("the blind scheme needs two channels or more"));
    for (std::size_t channel = 0; channel < channels(); ++channel) {
        const Poles& poles = settings.poles[settings.poles.size() == 1 ? 0 : channel];
        const auto gain = blind_gain(plant_, axis_bit(channel), poles);
        if (!gain) return tl::unexpected(fmt::format("the observer without channel {}: {}", channel, gain.error()));
        add(axis_bit(channel), *gain);
    }
    if (channels() < 3) return {};
    for (std::size_t i = 0; i < channels(); ++i) {
        for (std::size_t j = i + 1; j < channels(); ++j) {
            const auto gain = blind_gain(plant_, axis_bit(i) | axis_bit(j), settings.poles.front());
            if (gain) add(axis_bit(i) | axis_bit(j), *gain);
        }
    }
    return {};
}

void ObserverBank::add(AxisMask channels, const Eigen::MatrixXd& gain)
{
    const Eigen::Index n = plant_.states();
    const Eigen::MatrixXd error_matrix = plant_.a - gain * plant_.c;
    const auto hold = geometry::zero_order_hold(error_matrix, Eigen::MatrixXd::Identity(n, n), interval_s_);
    Observer& observer = observers_.emplace_back();
    observer.channels = channels;
    observer.gain = gain;
    observer.correct = gain;
    observer.state = hold.state;
    observer.drive = hold.input;
    observer.estimate = State::Zero(n);
    observer.residual = observer.limit = observer.noise_limit = observer.direction = Outputs::Zero(plant_.outputs());
    observer.sensitivity = Sensitivity::Zero(n, static_cast<Eigen::Index>(parameters_.size()) + 1);
    if (scheme_ == ObserverScheme::directional) observer.direction = (plant_.c * gain.col(std::countr_zero(channels))).normalized();
}

void ObserverBank::set_noise(const ObserverSettings& settings)
{
    variance_.resize(plant_.outputs());
    for (std::size_t channel = 0; channel < channels(); ++channel)
        variance_(static_cast<Eigen::Index>(channel)) = std::pow(sigma_of(settings, channel), 2);
    const auto p = static_cast<double>(channels());
    const double compared = scheme_ == ObserverScheme::directional ? p : p * (p - 1);
    z_ = normal_quantile(settings.false_alarm_probability / (2 * compared));
    for (Observer& observer : observers_) {
        const Eigen::MatrixXd drive = observer.drive * observer.gain;
        observer.disturbance = drive * variance_.asDiagonal() * drive.transpose();
    }
    start(Outputs::Zero(plant_.outputs()), 0);
}

/// var r = C P C' + R
void ObserverBank::set_noise_limits(Observer& observer) const
{
    OutputMatrix variance = c_.lazyProduct(OutputMatrix(observer.covariance.lazyProduct(c_.transpose())));
    variance.diagonal() += variance_;
    observer.noise_limit = z_ * variance.diagonal().cwiseSqrt();
    if (scheme_ != ObserverScheme::directional) return;
    observer.metric_noise_limit = z_ * std::sqrt(observer.direction.dot(Outputs(variance.lazyProduct(observer.direction))));
}

/// The response of all observers to a step on each channel, until it has settled: e' = (A - K C) e - K f, r = C e + f.
void ObserverBank::set_attribution_frames()
{
    double rate = std::numeric_limits<double>::infinity();
    for (const Observer& observer : observers_) rate = std::min(rate, slowest_rate(plant_.a - observer.gain * plant_.c));
    const auto frames = static_cast<std::uint64_t>(std::ceil(-std::log(settled) / rate / interval_s_));
    for (std::size_t faulty = 0; faulty < channels(); ++faulty) {
        const Eigen::VectorXd fault = Eigen::VectorXd::Unit(plant_.outputs(), static_cast<Eigen::Index>(faulty));
        std::vector<Eigen::VectorXd> errors(observers_.size(), Eigen::VectorXd::Zero(plant_.states()));
        for (std::uint64_t frame = 0; frame < frames; ++frame) {
            std::size_t named = 0;
            double largest = 0;
            for (std::size_t i = 0; i < observers_.size(); ++i) {
                const Observer& observer = observers_[i];
                const double ratio = std::abs(observer.direction.dot(plant_.c * errors[i] + fault)) / observer.metric_limit;
                if (ratio > largest) named = i;
                largest = std::max(largest, ratio);
                errors[i] = (observer.state * errors[i] - observer.drive * observer.gain * fault).eval();
            }
            if (named != faulty) attribution_frames_ = std::max(attribution_frames_, (frame + 1) * 3 / 2 + 1);
        }
    }
}

std::optional<std::size_t> ObserverBank::find(AxisMask channels) const
{
    for (std::size_t observer = 0; observer < observers_.size(); ++observer) {
        if (observers_[observer].channels == channels) return observer;
    }
    return std::nullopt;
}

Poles ObserverBank::poles(std::size_t observer) const
{
    return poles_of(plant_.a - observers_[observer].gain * plant_.c);
}

std::uint64_t ObserverBank::start(const Outputs& samples, AxisMask valid)
{
    Outputs usable = samples;
    for (Eigen::Index channel = 0; channel < usable.size(); ++channel)
        if (!has_axis(valid, static_cast<std::size_t>(channel))) usable(channel) = 0;
    for (Observer& observer : observers_) {
        observer.estimate = from_samples_.lazyProduct(usable);
        observer.residual.setZero();
        observer.sensitivity.setZero();
        observer.covariance = from_samples_.lazyProduct(SmallMatrix(variance_.asDiagonal() * from_samples_.transpose()));
        set_noise_limits(observer);
        set_limits(observer);
    }
    return state_is_measured_ && valid == all_axes(channels()) ? 0 : settling_frames_;
}

void ObserverBank::compare(const Outputs& samples, AxisMask valid)
{
    for (Observer& observer : observers_) {
        observer.residual = -c_.lazyProduct(observer.estimate);
        for (Eigen::Index channel = 0; channel < samples.size(); ++channel) {
            if (has_axis(valid, static_cast<std::size_t>(channel))) observer.residual(channel) += samples(channel);
            else observer.residual(channel) = 0;
        }
        set_limits(observer);
    }
}

void ObserverBank::advance(const Inputs& input)
{
    for (Observer& observer : observers_) {
        // K y = K (r + C xh): a sample that is missing (r = 0) corrects nothing.
        const Outputs held = observer.residual + c_.lazyProduct(observer.estimate);
        const State driven = observer.correct.lazyProduct(held) + b_.lazyProduct(input);
        const State next = observer.state.lazyProduct(observer.estimate) + observer.drive.lazyProduct(driven);
        if (!threshold_) {
            advance_sensitivity(observer, input);
            observer.covariance = observer.state.lazyProduct(StateMatrix(observer.covariance.lazyProduct(observer.state.transpose())));
            observer.covariance += observer.disturbance;
            set_noise_limits(observer);
        }
        observer.estimate = next;
    }
}

void ObserverBank::advance_sensitivity(Observer& observer, const Inputs& input) const
{
    const State motion = a_.lazyProduct(observer.estimate) + b_.lazyProduct(input);
    const Outputs held_back = c_.lazyProduct(motion) * (interval_s_ / 2);
    observer.sensitivity = Sensitivity(observer.state.lazyProduct(observer.sensitivity));
    observer.sensitivity.col(0) += observer.drive.lazyProduct(State(observer.correct.lazyProduct(held_back)));
    for (std::size_t index = 0; index < parameters_.size(); ++index) {
        const Parameter& parameter = parameters_[index];
        const Eigen::Index states = plant_.states();
        const double value = parameter.column < states ? observer.estimate(parameter.column) : input(parameter.column - states);
        observer.sensitivity.col(static_cast<Eigen::Index>(index) + 1) += observer.drive.col(parameter.row) * (parameter.size * value);
    }
}

double ObserverBank::metric(std::size_t observer) const
{
    return std::abs(observers_[observer].direction.dot(observers_[observer].residual));
}

void ObserverBank::set_limits(Observer& observer) const
{
    if (threshold_) {
        observer.limit.setConstant(*threshold_);
        observer.metric_limit = *threshold_;
        return;
    }
    const OutputSensitivity change = c_.lazyProduct(observer.sensitivity);
    const Eigen::Index parameters = change.cols() - 1;
    observer.limit =
        observer.noise_limit + change.col(0).cwiseAbs() + model_error_ * change.rightCols(parameters).cwiseAbs().rowwise().sum();
    if (scheme_ != ObserverScheme::directional) return;
    double uncertain = 0;
    for (Eigen::Index index = 1; index <= parameters; ++index) uncertain += std::abs(observer.direction.dot(change.col(index)));
    observer.metric_limit = observer.metric_noise_limit + std::abs(observer.direction.dot(change.col(0))) + model_error_ * uncertain;
}

}  // namespace quorient::fdi
