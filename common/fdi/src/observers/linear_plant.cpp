#include "quorient/fdi/observer_bank.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>

namespace quorient::fdi {
namespace {

tl::expected<void, std::string> check_size(const char* name, const Eigen::MatrixXd& matrix, Eigen::Index rows, Eigen::Index columns)
{
    if (matrix.rows() != rows || matrix.cols() != columns)
        return tl::unexpected(fmt::format("{} must be {} x {}, got {} x {}", name, rows, columns, matrix.rows(), matrix.cols()));
    if (!matrix.allFinite()) return tl::unexpected(fmt::format("{} holds a value that is not finite", name));
    return {};
}

/// As a share of the largest singular value: below it a direction counts as not seen.
constexpr double rank_tolerance = 1e-9;

}  // namespace

tl::expected<void, std::string> check(const LinearPlant& plant)
{
    const Eigen::Index n = plant.a.rows();
    if (n < 1 || n > max_states) return tl::unexpected(fmt::format("A must have 1 to {} rows, got {}", max_states, n));
    if (plant.outputs() < 1 || plant.outputs() > max_outputs)
        return tl::unexpected(fmt::format("C must have 1 to {} rows, got {}", max_outputs, plant.outputs()));
    if (plant.inputs() < 1 || plant.inputs() > max_inputs)
        return tl::unexpected(fmt::format("B must have 1 to {} columns, got {}", max_inputs, plant.inputs()));
    if (auto sized = check_size("A", plant.a, n, n); !sized) return sized;
    if (auto sized = check_size("B", plant.b, n, plant.inputs()); !sized) return sized;
    return check_size("C", plant.c, plant.outputs(), n);
}

Poles poles_of(const Eigen::MatrixXd& matrix)
{
    if (matrix.size() == 0) return {};
    const Eigen::VectorXcd values = matrix.eigenvalues();
    return {values.begin(), values.end()};
}

std::string to_string(const Poles& poles)
{
    std::string text;
    for (const auto& pole : poles) {
        if (pole.imag() < 0) continue;
        if (!text.empty()) text += ", ";
        text += pole.imag() == 0 ? fmt::format("{:.6g}", pole.real()) : fmt::format("{:.6g} +- {:.6g}i", pole.real(), pole.imag());
    }
    return text;
}

tl::expected<void, std::string> check_poles(const Poles& poles, Eigen::Index count)
{
    if (static_cast<Eigen::Index>(poles.size()) != count)
        return tl::unexpected(fmt::format("{} observer poles are needed, got {}", count, poles.size()));
    for (const auto& pole : poles) {
        if (!std::isfinite(pole.real()) || !std::isfinite(pole.imag())) return tl::unexpected(std::string("a pole is not finite"));
        if (!(pole.real() < 0))
            return tl::unexpected(
                fmt::format("the observer would not be stable: pole {} is not in the left half plane", to_string({pole})));
        const auto conjugates = std::count(poles.begin(), poles.end(), std::conj(pole));
        if (conjugates != std::count(poles.begin(), poles.end(), pole))
            return tl::unexpected(fmt::format("pole {:.6g}{:+.6g}i comes without its conjugate", pole.real(), pole.imag()));
    }
    return {};
}

Observability observability(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c)
{
    const Eigen::Index n = a.rows();
    const double scale = std::max(a.norm(), 1e-300);  // so that the powers of A stay comparable
    Eigen::MatrixXd stacked(c.rows() * n, n);
    Eigen::MatrixXd power = c;
    for (Eigen::Index k = 0; k < n; ++k) {
        stacked.middleRows(k * c.rows(), c.rows()) = power;
        power = power * a / scale;
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(stacked, Eigen::ComputeFullV);
    Eigen::Index rank = 0;
    for (const double value : svd.singularValues()) rank += value > rank_tolerance * std::max(svd.singularValues()(0), 1e-300) ? 1 : 0;
    const Eigen::MatrixXd directions = svd.matrixV().transpose();
    return {directions.topRows(rank), directions.bottomRows(n - rank)};
}

}  // namespace quorient::fdi
