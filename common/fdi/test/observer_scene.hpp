#pragma once

#include "quorient/fdi/observer_detector.hpp"
#include "quorient/geometry/zero_order_hold.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace quorient::fdi::test {

/// The vessel of docs/methods/observers.md (m = 15, I_z = 8, x_G = 0.5, u_0 = 2), as numbers so that nothing of ours is its own witness.
inline LinearPlant paper_vessel()
{
    LinearPlant plant;
    plant.a = Eigen::MatrixXd{{0.3414634146341463, -1.8536585365853657}, {2.1463414634146343, -3.3658536585365857}};
    plant.b = Eigen::MatrixXd{{0.1951219512195122}, {3.5121951219512195}};
    plant.c = Eigen::Matrix2d::Identity();
    return plant;
}

inline ObserverSettings paper_settings(ObserverScheme scheme)
{
    ObserverSettings settings;
    settings.plant = paper_vessel();
    settings.scheme = scheme;
    if (scheme == ObserverScheme::directional) settings.poles = {{-3, -4}, {-0.5, -4}};
    else settings.poles = {{-3, -4}};
    settings.threshold = 1e-3;
    return settings;
}

/// The paper's run: rudder 0.01 sin(2 pi t / 20), 0.01 on the yaw rate during 20-30 s and on the sway velocity during 50-70 s, 100 Hz.
struct PaperRun {
    LinearPlant plant = paper_vessel();
    double noise = 0;
    unsigned seed = 1;
    double gyro_fault = 0.01;
    double accelerometer_fault = 0.01;
    double rudder_rad = 0.01;
    double interval_s = 0.01;
    double duration_s = 80;

    /// @param see  (time, state, samples, rudder) of every frame.
    void play(const std::function<void(double, const Eigen::VectorXd&, const Eigen::VectorXd&, double)>& see) const
    {
        const auto hold = geometry::zero_order_hold(plant.a, plant.b, interval_s);
        std::mt19937 random(seed);
        std::normal_distribution<double> gauss;
        Eigen::VectorXd state = Eigen::VectorXd::Zero(plant.states());
        const auto frames = static_cast<int>(std::lround(duration_s / interval_s));
        for (int k = 0; k <= frames; ++k) {
            const double time = k * interval_s;
            const double rudder = rudder_rad * std::sin(2 * std::numbers::pi * time / 20);
            Eigen::VectorXd sample = plant.c * state;
            if (k >= 2000 && k < 3000) sample(1) += gyro_fault;
            if (k >= 5000 && k < 7000) sample(0) += accelerometer_fault;
            if (noise > 0) sample = sample.unaryExpr([&](double value) { return value + noise * gauss(random); });
            see(time, state, sample, rudder);
            state = hold.state * state + hold.input * rudder;
        }
    }
};

/// The bank's view of the run.
inline void follow(const PaperRun& run, ObserverBank& bank, const std::function<void(double, const Eigen::VectorXd&)>& see)
{
    bool started = false;
    run.play([&](double time, const Eigen::VectorXd& state, const Eigen::VectorXd& sample, double rudder) {
        if (!started) bank.start(sample, all_axes(bank.channels()));
        started = true;
        bank.compare(sample, all_axes(bank.channels()));
        see(time, state);
        bank.advance(ObserverBank::Inputs::Constant(1, rudder));
    });
}

/// The detector's view of the run.
inline void follow(const PaperRun& run, Detector& detector, const std::function<void(double, const Assessment&)>& see)
{
    std::uint64_t sequence = 0;
    Assessment assessment;
    run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
        const Eigen::VectorXd increment = sample * run.interval_s;
        const std::array<double, 4> input{rudder, 0, 0, 0};
        detector.assess({.identity = {1, sequence++},
                         .interval_s = run.interval_s,
                         .increment = {increment.data(), static_cast<std::size_t>(increment.size())},
                         .valid = all_axes(static_cast<std::size_t>(increment.size())),
                         .known_input = input},
                        assessment);
        see(time, assessment);
    });
}

}  // namespace quorient::fdi::test
