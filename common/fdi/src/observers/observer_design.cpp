#include "observers/observer_design.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace quorient::fdi {
namespace {

/// Relative to the matrices at hand: below it a denominator, a determinant or an angle counts as zero.
constexpr double vanishing = 1e-9;

/// Coefficients of prod (s - pole), lowest power first, highest = 1.
Eigen::VectorXd polynomial(const Poles& poles)
{
    Eigen::VectorXcd coefficients = Eigen::VectorXcd::Ones(1);
    for (const auto& pole : poles) {
        Eigen::VectorXcd next = Eigen::VectorXcd::Zero(coefficients.size() + 1);
        next.tail(coefficients.size()) += coefficients;
        next.head(coefficients.size()) -= pole * coefficients;
        coefficients = next;
    }
    return coefficients.real();
}

/// Ackermann's formula for one output: k = phi(A) O^-1 (0 .. 0 1)'. Empty where c does not see all of A.
Eigen::VectorXd ackermann(const Eigen::MatrixXd& a, const Eigen::RowVectorXd& c, const Poles& poles)
{
    const Eigen::Index n = a.rows();
    Eigen::MatrixXd seen(n, n);
    seen.row(0) = c;
    for (Eigen::Index row = 1; row < n; ++row) seen.row(row) = seen.row(row - 1) * a;
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(seen);
    if (!lu.isInvertible()) return {};
    const Eigen::VectorXd coefficients = polynomial(poles);
    Eigen::MatrixXd phi = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index power = n - 1; power >= 0; --power) phi = phi * a + coefficients(power) * Eigen::MatrixXd::Identity(n, n);
    return phi * lu.solve(Eigen::VectorXd::Unit(n, n - 1));
}

/// Largest distance of a wanted pole from the nearest one that came out; multiple poles are sensitive to rounding as eps^(1/n).
double placement_error(const Eigen::MatrixXd& matrix, const Poles& wanted)
{
    Poles found = poles_of(matrix);
    double worst = 0;
    for (const auto& pole : wanted) {
        const auto nearest = std::min_element(found.begin(), found.end(),
                                              [&](const auto& x, const auto& y) { return std::abs(x - pole) < std::abs(y - pole); });
        worst = std::max(worst, std::abs(*nearest - pole) / std::abs(pole));
        found.erase(nearest);
    }
    return worst;
}

/// Poles of A - K C by a combination g C of the outputs, K = K0 + k g. K0 is tried as 0 first; a plant in which several modes share a
/// pole (no single combination sees them apart) needs K0 different from it. The best conditioned of a fixed set of trials is taken.
tl::expected<Eigen::MatrixXd, std::string> place(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c, const Poles& poles)
{
    constexpr int trials = 40;
    constexpr double tolerance = 1e-3;
    std::mt19937 random(2021);  // a design, not a sample: the same on every machine
    const auto uniform = [&random](double size) { return size * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
    Eigen::MatrixXd best;
    double best_error = tolerance;
    for (int trial = 0; trial < trials; ++trial) {
        Eigen::RowVectorXd combination = Eigen::RowVectorXd::Ones(c.rows());
        Eigen::MatrixXd feedback = Eigen::MatrixXd::Zero(a.rows(), c.rows());
        if (trial > 0) combination = combination.unaryExpr([&](double) { return uniform(1.0); });
        if (trial > trials / 2) feedback = feedback.unaryExpr([&](double) { return uniform(a.norm() + 1.0); });
        const Eigen::VectorXd gain = ackermann(a - feedback * c, combination * c, poles);
        if (gain.size() == 0) continue;
        const Eigen::MatrixXd candidate = feedback + gain * combination;
        const double error = placement_error(a - candidate * c, poles);
        if (!(error < best_error)) continue;
        best_error = error;
        best = candidate;
        if (c.rows() == 1 || error < 1e-9) break;
    }
    if (best.size() == 0) return tl::unexpected(fmt::format("no gain was found that places the poles {}; try others", to_string(poles)));
    return best;
}

}  // namespace

tl::expected<Eigen::Matrix2d, std::string> directional_gain(const Eigen::MatrixXd& a, Eigen::Index channel, double fault_pole,
                                                            double other_pole)
{
    if (a.rows() != 2 || a.cols() != 2)
        return tl::unexpected(fmt::format("the directional scheme needs two states, got {} x {}", a.rows(), a.cols()));
    if (auto stable = check_poles({fault_pole, other_pole}, 2); !stable) return tl::unexpected(stable.error());
    const double tiny = vanishing * std::max(a.norm(), 1e-300);
    const double j = -(fault_pole + other_pole);
    const double q = fault_pole * other_pole;
    Eigen::Matrix2d k;
    k(0, 0) = 1;
    k(1, 1) = j - 1 + a(0, 0) + a(1, 1);
    const double cross = (a(0, 0) - 1) * (a(1, 1) - k(1, 1)) - q;
    const Eigen::Index other = 1 - channel;
    const double divisor = a(channel, channel) - other_pole;
    if (std::abs(divisor) < tiny)
        return tl::unexpected(fmt::format("channel {}: pole {} equals a{}{} and makes the fault direction undefined; choose another",
                                          channel, other_pole, channel + 1, channel + 1));
    k(other, channel) = k(channel, channel) * a(other, channel) / divisor;
    const double coupling = a(other, channel) - k(other, channel);
    if (std::abs(coupling) < tiny)
        return tl::unexpected(
            fmt::format("channel {}: with poles {}, {} the states decouple (a{}{} = k{}{}), and no gain gives the direction; "
                        "choose others",
                        channel, fault_pole, other_pole, other + 1, channel + 1, other + 1, channel + 1));
    k(channel, other) = a(channel, other) - cross / coupling;
    return k;
}

tl::expected<void, std::string> check_conditions(const Eigen::MatrixXd& a, const std::vector<Eigen::MatrixXd>& gains)
{
    Eigen::Matrix2d directions;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const Eigen::MatrixXd& k = gains[static_cast<std::size_t>(i)];
        const Eigen::Vector2d direction = k.col(i);
        const Eigen::Vector2d moved = (a - k) * direction;
        Eigen::Matrix2d both;
        both << direction.normalized(), moved.normalized();
        if (std::abs(both.determinant()) > 1e-6)
            return tl::unexpected(fmt::format("condition 1: under a fault of channel {} the error leaves its direction", i));
        for (const auto& pole : poles_of(a - k)) {
            if (!(pole.real() < 0))
                return tl::unexpected(
                    fmt::format("condition 2: the observer of channel {} is not stable, poles {}", i, to_string(poles_of(a - k))));
        }
        directions.col(i) = direction.normalized();
    }
    if (std::abs(directions.determinant()) < 1e-3)
        return tl::unexpected(std::string("condition 3: the two fault directions are parallel, so the two faults look alike"));
    return {};
}

std::vector<double> contrast(const LinearPlant& plant, const std::vector<Eigen::MatrixXd>& gains)
{
    std::vector<double> steady;
    for (Eigen::Index faulty = 0; faulty < plant.outputs(); ++faulty) {
        double own = 0;
        double others = 0;
        for (Eigen::Index i = 0; i < plant.outputs(); ++i) {
            const Eigen::MatrixXd& k = gains[static_cast<std::size_t>(i)];
            const Eigen::VectorXd fault = Eigen::VectorXd::Unit(plant.outputs(), faulty);
            const Eigen::VectorXd error = (plant.a - k * plant.c).partialPivLu().solve(k * fault);  // e' = 0
            const Eigen::VectorXd residual = plant.c * error + fault;
            const double metric = std::abs((plant.c * k.col(i)).normalized().dot(residual));
            if (i == faulty) own = metric;
            else others = std::max(others, metric);
        }
        steady.push_back(others > 0 ? own / others : std::numeric_limits<double>::infinity());
    }
    return steady;
}

tl::expected<Eigen::MatrixXd, std::string> blind_gain(const LinearPlant& plant, AxisMask blind, const Poles& poles)
{
    std::vector<Eigen::Index> used;
    for (Eigen::Index row = 0; row < plant.outputs(); ++row) {
        if (!has_axis(blind, static_cast<std::size_t>(row))) used.push_back(row);
    }
    if (used.empty()) return tl::unexpected(std::string("an observer that ignores every sensor cannot follow anything"));
    const Eigen::MatrixXd c = plant.c(used, Eigen::all);
    const Observability split = observability(plant.a, c);
    const Eigen::MatrixXd unseen = split.unseen * plant.a * split.unseen.transpose();
    for (const auto& pole : poles_of(unseen)) {
        if (pole.real() < 0) continue;
        return tl::unexpected(fmt::format("the sensors {} cannot stabilise an observer: they do not see the plant's pole {}",
                                          fmt::join(used, ", "), to_string({pole})));
    }
    const Eigen::MatrixXd seen = split.seen * plant.a * split.seen.transpose();
    const Poles wanted(poles.begin(), poles.begin() + std::min<std::ptrdiff_t>(seen.rows(), static_cast<std::ptrdiff_t>(poles.size())));
    if (auto checked = check_poles(wanted, seen.rows()); !checked) return tl::unexpected(checked.error());
    const auto reduced = place(seen, c * split.seen.transpose(), wanted);
    if (!reduced) return reduced;
    Eigen::MatrixXd gain = Eigen::MatrixXd::Zero(plant.states(), plant.outputs());
    gain(Eigen::all, used) = split.seen.transpose() * *reduced;
    if (gain.norm() < vanishing * std::max(plant.a.norm(), 1e-300))
        return tl::unexpected(
            fmt::format("the poles {} are the plant's own: the observer would not listen to its sensors", to_string(poles)));
    return gain;
}

}  // namespace quorient::fdi
