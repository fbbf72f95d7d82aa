#include "fit.hpp"

#include "rates.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace quorient::diagnosis {
namespace {

using Row = Eigen::Vector4d;  // 1, u

constexpr double usual_gain_error = 0.1;  // holds directions in which nothing moved
constexpr double usual_bias_rad_s = 20 * degree;
constexpr double huber_sigmas = 1.5;
constexpr int rounds = 6;
constexpr double least_noise_rad_s = 0.02 * degree;
constexpr std::size_t least_blocks_to_fit = 10;

struct Equations {
    std::vector<Row> rows;
    std::vector<Eigen::Vector3d> measured;
};

Equations equations_of(const Overview& overview, const Mountings& mountings, std::size_t m, std::uint32_t others)
{
    Equations found;
    for (const Block& block : overview.blocks()) {
        if ((block.present >> m & 1U) == 0) continue;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double used = 0;
        for (std::size_t j = 0; j < overview.instruments(); ++j) {
            if ((others & block.present & 1U << j) == 0) continue;
            sum += mountings.of[j].turned * block.rate_rad_s[j].cast<double>() / mountings.of[j].scale;
            used += 1;
        }
        if (used == 0) continue;
        const Eigen::Vector3d along = mountings.of[m].turned.transpose() * (sum / used);
        found.rows.emplace_back(1, along.x(), along.y(), along.z());
        found.measured.emplace_back(block.rate_rad_s[m].cast<double>() / mountings.of[m].scale);
    }
    return found;
}

struct AxisSolution {
    Row value;
    Row sigma;
};

AxisSolution solve(const Equations& equations, Eigen::Index axis)
{
    Row usual(0, 0, 0, 0);
    usual(axis + 1) = 1;
    Row prior = Row::Constant(1 / (usual_gain_error * usual_gain_error));
    prior(0) = 1 / (usual_bias_rad_s * usual_bias_rad_s);
    AxisSolution solution{usual, {}};
    double noise = 0;
    for (int round = 0; round < rounds; ++round) {
        Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
        Row moment = Row::Zero();
        std::vector<double> sizes;
        for (std::size_t i = 0; i < equations.rows.size(); ++i) {
            const double y = equations.measured[i](axis);
            const double residual = std::abs(y - solution.value.dot(equations.rows[i]));
            const double weight = round == 0 ? 1 : std::min(1.0, huber_sigmas * noise / std::max(residual, 1e-12));
            normal += weight * equations.rows[i] * equations.rows[i].transpose();
            moment += weight * y * equations.rows[i];
        }
        const double variance = noise > 0 ? noise * noise : 1e-4;
        normal.diagonal() += variance * prior;
        moment += variance * prior.cwiseProduct(usual);
        const Eigen::LDLT<Eigen::Matrix4d> solver(normal);
        solution.value = solver.solve(moment);
        for (std::size_t i = 0; i < equations.rows.size(); ++i)
            sizes.push_back(std::abs(equations.measured[i](axis) - solution.value.dot(equations.rows[i])));
        noise = std::max(least_noise_rad_s, 1.483 * median(sizes));
        solution.sigma = (noise * noise * solver.solve(Eigen::Matrix4d::Identity()).diagonal()).cwiseMax(0).cwiseSqrt();
    }
    return solution;
}

}  // namespace

std::optional<Fit> fit_against(const Overview& overview, const Mountings& mountings, std::size_t m, std::uint32_t others)
{
    const Equations equations = equations_of(overview, mountings, m, others);
    if (equations.rows.size() < least_blocks_to_fit) return std::nullopt;
    Fit fit;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const AxisSolution solution = solve(equations, axis);
        fit.bias_rad_s(axis) = solution.value(0);
        fit.gain.row(axis) = solution.value.tail<3>().transpose();
        fit.gain_sigma(axis) = solution.sigma(axis + 1);
    }
    return fit;
}

}  // namespace quorient::diagnosis
