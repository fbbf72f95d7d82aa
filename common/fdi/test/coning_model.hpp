#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <random>

namespace quorient::fdi {

/// The motion of paper 003, eqs (46)-(48) with the corrected factor 2 sin(k3 h / 2) in (48): an independent oracle for the tests.
struct ConingModel {
    double k2 = 0.084;
    double k3 = 0.05;
    double mu = -0.6;
    double nu = 0.8;

    Eigen::Vector4d attitude(double t) const
    {
        const double c2 = std::cos(k2 * t / 2), s2 = std::sin(k2 * t / 2), c3 = std::cos(k3 * t / 2), s3 = std::sin(k3 * t / 2);
        return {mu * c2 * c3 + nu * s2 * s3, mu * c2 * s3 - nu * s2 * c3, mu * s2 * c3 + nu * c2 * s3, nu * c2 * c3 - mu * s2 * s3};
    }

    Eigen::Vector3d rate(double t) const { return {k3, k2 * std::cos(k3 * t), -k2 * std::sin(k3 * t)}; }

    /// The integral of the rate from t to t + h.
    Eigen::Vector3d increment(double t, double h) const
    {
        const double chord = 2 * k2 / k3 * std::sin(k3 * h / 2);
        return {k3 * h, chord * std::cos(k3 * (t + h / 2)), -chord * std::sin(k3 * (t + h / 2))};
    }
};

/// A quantiser that carries its remainder, one per axis, as an angle encoder's counter does.
class CarryingQuantiser {
public:
    CarryingQuantiser(double quantum, std::mt19937_64& random) : quantum_(quantum)
    {
        for (double& remainder : remainder_) remainder = std::uniform_real_distribution<double>(0, quantum)(random);
    }

    double operator()(std::size_t axis, double increment)
    {
        remainder_[axis] += increment;
        const double counted = std::floor(remainder_[axis] / quantum_) * quantum_;
        remainder_[axis] -= counted;
        return counted;
    }

private:
    double quantum_;
    std::array<double, 4> remainder_{};
};

}  // namespace quorient::fdi
