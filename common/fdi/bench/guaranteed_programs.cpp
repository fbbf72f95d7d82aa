#include "guaranteed_programs.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace quorient::fdi {

GuaranteedPrograms::GuaranteedPrograms(const geometry::Axes& axes, double bound) : axes_(axes), bound_(bound)
{
    assert(axes.rows() == 6);
    glp_init_smcp(&parameters_);
    parameters_.msg_lev = GLP_MSG_OFF;
    parameters_.presolve = GLP_OFF;
    parameters_.tol_bnd = 1e-9;  // relative to |z|, which is hundreds of sigma: the default would give away 1e-5 sigma
    parameters_.tol_dj = 1e-9;
    for (std::size_t first = 0; first < 6; ++first)
        for (std::size_t second = first + 1; second < 6; ++second) {
            Pair pair{std::unique_ptr<glp_prob, Delete>(glp_create_prob()), {}};
            for (std::size_t axis = 0; axis < 6; ++axis)
                if (axis != first && axis != second) pair.axis.push_back(axis);
            glp_prob* problem = pair.problem.get();
            glp_add_rows(problem, 4);
            glp_add_cols(problem, 3);
            for (int column = 1; column <= 3; ++column) glp_set_col_bnds(problem, column, GLP_FR, 0, 0);
            for (int row = 1; row <= 4; ++row) {
                const auto h = axes.row(static_cast<Eigen::Index>(pair.axis[static_cast<std::size_t>(row - 1)]));
                const std::array<int, 4> column{0, 1, 2, 3};
                const std::array<double, 4> value{0, h(0), h(1), h(2)};
                glp_set_mat_row(problem, row, 3, column.data(), value.data());
            }
            pairs_.push_back(std::move(pair));
        }
}

std::optional<GuaranteedPrograms::Hull> GuaranteedPrograms::solve(const std::vector<double>& z, Start start)
{
    Hull hull;
    hull.lower.fill(std::numeric_limits<double>::infinity());
    hull.upper.fill(-std::numeric_limits<double>::infinity());
    bool feasible = false;
    for (const Pair& pair : pairs_) {
        for (int row = 1; row <= 4; ++row) {
            const double value = z[pair.axis[static_cast<std::size_t>(row - 1)]];
            glp_set_row_bnds(pair.problem.get(), row, GLP_DB, value - bound_, value + bound_);
        }
        for (std::size_t axis = 0; axis < 6; ++axis)
            for (const int sense : {GLP_MAX, GLP_MIN}) {
                const auto best = optimum(pair, axis, sense, start);
                if (!best) continue;
                feasible = true;
                if (sense == GLP_MAX) hull.upper[axis] = std::max(hull.upper[axis], *best);
                else hull.lower[axis] = std::min(hull.lower[axis], *best);
            }
    }
    if (!feasible) return {};
    return hull;
}

std::optional<double> GuaranteedPrograms::optimum(const Pair& pair, std::size_t axis, int sense, Start start) const
{
    glp_prob* problem = pair.problem.get();
    for (int column = 1; column <= 3; ++column) glp_set_obj_coef(problem, column, axes_(static_cast<Eigen::Index>(axis), column - 1));
    glp_set_obj_dir(problem, sense);
    if (start == Start::standard_basis) glp_std_basis(problem);
    if (glp_simplex(problem, &parameters_) != 0 || glp_get_status(problem) != GLP_OPT) return {};
    return glp_get_obj_val(problem);
}

}  // namespace quorient::fdi
