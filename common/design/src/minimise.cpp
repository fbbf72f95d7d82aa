#include "minimise.hpp"

#include <Eigen/QR>
#include <nlopt.h>
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double constraint_tolerance = 1e-13;
constexpr int most_evaluations = 400;
constexpr int most_repetitions = 4;
constexpr double improvement = 1e-13;  // values are of order one
constexpr double dependent = 1e-7;      // derivatives are of order one
constexpr int blind_evaluations_per_variable = 60;

struct Destroy {
    void operator()(nlopt_opt opt) const { nlopt_destroy(opt); }
};
using Optimiser = std::unique_ptr<nlopt_opt_s, Destroy>;

/// What NLopt's callbacks work on. One more variable behind x, the level t, where several values are to stay below it.
struct Work {
    const MinimaxProblem& problem;
    bool level;

    VectorXd x_of(unsigned n, const double* x) const { return Eigen::Map<const VectorXd>(x, static_cast<Index>(n) - (level ? 1 : 0)); }
};

/// Copies derivatives to NLopt's rows of n entries, where it asks for them; the column of the level gets `slope`.
void write(const Work& work, unsigned n, const Eigen::MatrixXd& derivative, double slope, double* gradient)
{
    if (gradient == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> rows(gradient, derivative.rows(), static_cast<Index>(n));
    rows.leftCols(derivative.cols()) = derivative;
    if (work.level) rows.rightCols(1).setConstant(slope);
}

void write(const Work& work, unsigned n, const VectorXd& values, const Eigen::MatrixXd& derivative, double slope, double* result, double* gradient)
{
    std::copy_n(values.data(), values.size(), result);
    write(work, n, derivative, slope, gradient);
}

double level_or_value(unsigned n, const double* x, double* gradient, void* data)
{
    const Work& work = *static_cast<const Work*>(data);
    if (work.level) {
        if (gradient != nullptr) {
            std::fill_n(gradient, n, 0.0);
            gradient[n - 1] = 1;
        }
        return x[n - 1];
    }
    VectorXd values;
    Eigen::MatrixXd derivative;
    work.problem.minimised(work.x_of(n, x), values, gradient != nullptr ? &derivative : nullptr);
    write(work, n, derivative, 0, gradient);
    return values[0];
}

void below_level(unsigned, double* result, unsigned n, const double* x, double* gradient, void* data)
{
    const Work& work = *static_cast<const Work*>(data);
    VectorXd values;
    Eigen::MatrixXd derivative;
    work.problem.minimised(work.x_of(n, x), values, gradient != nullptr ? &derivative : nullptr);
    write(work, n, values.array() - x[n - 1], derivative, -1, result, gradient);
}

template <Values MinimaxProblem::*Constraint>
void constrained(unsigned, double* result, unsigned n, const double* x, double* gradient, void* data)
{
    const Work& work = *static_cast<const Work*>(data);
    VectorXd values;
    Eigen::MatrixXd derivative;
    (work.problem.*Constraint)(work.x_of(n, x), values, gradient != nullptr ? &derivative : nullptr);
    write(work, n, values, derivative, 0, result, gradient);
}

/// How far x is from what the constraints allow.
double violation(const MinimaxProblem& problem, const VectorXd& x)
{
    double worst = 0;
    VectorXd values;
    if (problem.zero) {
        problem.zero(x, values, nullptr);
        if (values.size() > 0) worst = std::max(worst, values.cwiseAbs().maxCoeff());
    }
    if (problem.not_above_zero) {
        problem.not_above_zero(x, values, nullptr);
        if (values.size() > 0) worst = std::max(worst, values.maxCoeff());
    }
    return worst;
}

double largest(const MinimaxProblem& problem, const VectorXd& x)
{
    VectorXd values;
    problem.minimised(x, values, nullptr);
    return values.maxCoeff();
}

unsigned count(const Values& values, const VectorXd& x)
{
    if (!values) return 0;
    VectorXd found;
    values(x, found, nullptr);
    return static_cast<unsigned>(found.size());
}

/// Picks, among values that are to be zero, those whose derivatives at x are independent. With others beside them no step would be found.
std::vector<Index> independent(const Values& zero, const VectorXd& x)
{
    VectorXd values;
    Eigen::MatrixXd derivative;
    zero(x, values, &derivative);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition(derivative.transpose());
    decomposition.setThreshold(dependent);
    const auto& order = decomposition.colsPermutation().indices();
    std::vector<Index> rows(order.data(), order.data() + decomposition.rank());
    std::ranges::sort(rows);
    return rows;
}

Values only(const Values& values, const std::vector<Index>& rows)
{
    if (rows.empty()) return {};
    return [&values, rows](const VectorXd& x, VectorXd& kept, Eigen::MatrixXd* derivative) {
        VectorXd all;
        values(x, all, derivative);
        kept = all(rows);
        if (derivative != nullptr) *derivative = Eigen::MatrixXd((*derivative)(rows, Eigen::all));
    };
}

VectorXd minimise_once(const MinimaxProblem& whole, const VectorXd& start)
{
    MinimaxProblem problem = whole;
    if (whole.zero) problem.zero = only(whole.zero, independent(whole.zero, start));
    VectorXd first;
    problem.minimised(start, first, nullptr);
    Work work{problem, first.size() > 1};
    std::vector<double> x(start.begin(), start.end());
    if (work.level) x.push_back(first.maxCoeff());

    const Optimiser optimiser(nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(x.size())));
    nlopt_set_min_objective(optimiser.get(), level_or_value, &work);
    nlopt_set_xtol_rel(optimiser.get(), 1e-15);
    nlopt_set_maxeval(optimiser.get(), most_evaluations);
    const auto constrain = [&](auto add, unsigned values, nlopt_mfunc function) {
        if (values == 0) return;
        const std::vector<double> tolerance(values, constraint_tolerance);
        add(optimiser.get(), values, function, &work, tolerance.data());
    };
    if (work.level) constrain(nlopt_add_inequality_mconstraint, static_cast<unsigned>(first.size()), below_level);
    constrain(nlopt_add_equality_mconstraint, count(problem.zero, start), constrained<&MinimaxProblem::zero>);
    constrain(nlopt_add_inequality_mconstraint, count(problem.not_above_zero, start), constrained<&MinimaxProblem::not_above_zero>);
    double reached = 0;
    nlopt_optimize(optimiser.get(), x.data(), &reached);  // where it stops early, the best point it found is in x
    return Eigen::Map<const VectorXd>(x.data(), start.size());
}

}  // namespace

VectorXd minimise(const MinimaxProblem& problem, const VectorXd& start)
{
    if (start.size() == 0 || count(problem.minimised, start) == 0) return start;
    VectorXd best = start;
    for (int repetition = 0; repetition < most_repetitions; ++repetition) {
        const VectorXd next = minimise_once(problem, best);
        if (!next.allFinite()) return best;
        const double closer = violation(problem, best) - violation(problem, next);
        const double lower = largest(problem, best) - largest(problem, next);
        if (closer < -constraint_tolerance * 1e3 || (closer < improvement && lower < 0)) return best;
        best = next;
        if (closer < improvement && lower < improvement) return best;
    }
    return best;
}

VectorXd minimise_without_derivatives(const std::function<double(const VectorXd&)>& cost, const Values& not_above_zero, const VectorXd& start,
                                      double first_step)
{
    if (start.size() == 0) return start;
    const MinimaxProblem problem{
        [&](const VectorXd& x, VectorXd& values, Eigen::MatrixXd*) { values = VectorXd::Constant(1, std::min(cost(x), 1e9)); },
        {},
        not_above_zero};
    Work work{problem, false};
    std::vector<double> x(start.begin(), start.end());
    const Optimiser optimiser(nlopt_create(NLOPT_LN_COBYLA, static_cast<unsigned>(x.size())));
    nlopt_set_min_objective(optimiser.get(), level_or_value, &work);
    nlopt_set_initial_step1(optimiser.get(), first_step);
    nlopt_set_xtol_abs1(optimiser.get(), 1e-10);
    nlopt_set_maxeval(optimiser.get(), blind_evaluations_per_variable * static_cast<int>(x.size() + 1));
    if (const unsigned constraints = count(not_above_zero, start); constraints > 0) {
        const std::vector<double> tolerance(constraints, constraint_tolerance);
        nlopt_add_inequality_mconstraint(optimiser.get(), constraints, constrained<&MinimaxProblem::not_above_zero>, &work, tolerance.data());
    }
    double reached = 0;
    nlopt_optimize(optimiser.get(), x.data(), &reached);
    const VectorXd found = Eigen::Map<const VectorXd>(x.data(), start.size());
    return found.allFinite() && cost(found) < cost(start) ? found : start;
}

}  // namespace quorient::design
