#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
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

}  // namespace quorient::fdi
