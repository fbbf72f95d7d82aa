#include "reference_cases.hpp"

#include "quorient/geometry/figures.hpp"
#include "quorient/geometry/parity_space.hpp"
#include "quorient/geometry/triads.hpp"

#include <gtest/gtest.h>

namespace quorient::geometry {
namespace {

using test::matrix_of;
using test::reference_cases;
using test::vector_of;

/// The worked cases with the names of their ids: `body(case, axes, tolerance)` for each.
template <class Body>
void for_each_case(const std::string& method, Body body)
{
    const auto cases = reference_cases(method);
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& one : *cases) {
        SCOPED_TRACE(one["id"].get<std::string>());
        body(one, Axes(matrix_of(one["input"]["H"])), one["tol"]["abs"].get<double>());
    }
}

TEST(ReferenceCases, accuracy)
{
    for_each_case("accuracy", [](const auto& one, const Axes& axes, double tolerance) {
        AxisMask used = all_axes(static_cast<std::size_t>(axes.rows()));
        for (const auto& removed : one["input"]["removed_1based"]) used &= ~axis_bit(removed.template get<std::size_t>() - 1);
        const auto figures = accuracy(axes, used);
        ASSERT_TRUE(figures);
        const auto& expected = one["expected"];
        for (int k = 0; k < 3; ++k)  // theirs are ascending
            EXPECT_NEAR(figures->eigenvalues(2 - k), expected["eig"][static_cast<std::size_t>(k)].template get<double>(), tolerance);
        EXPECT_NEAR(figures->trace, expected["trace"].template get<double>(), tolerance);
        EXPECT_NEAR(figures->volume, expected["volume"].template get<double>(), tolerance);
        EXPECT_NEAR(figures->condition, expected["cond"].template get<double>(), tolerance);
    });
}

TEST(ReferenceCases, parity004)
{
    for_each_case("parity004", [](const auto& one, const Axes& axes, double tolerance) {
        const auto& expected = one["expected"];
        const ParitySpace space(axes);
        const AxisMatrix equations = parity_equations(space);
        EXPECT_TRUE(parity_matrix(space).isApprox(matrix_of(expected["V_potter"]), tolerance));
        EXPECT_TRUE(equations.isApprox(matrix_of(expected["V_npar"]), tolerance));
        EXPECT_TRUE(isolation_index(equations).isApprox(matrix_of(expected["J"]), tolerance));
        EXPECT_TRUE(detection_index(space).isApprox(vector_of(expected["W_diag"]), tolerance));
        EXPECT_NEAR(f_d1(space), expected["Fd1"].template get<double>(), tolerance);
        EXPECT_NEAR(f_d2(space), expected["Fd2"].template get<double>(), tolerance);
        if (!expected.contains("Fd2_partner_excluded")) return;
        const std::vector<std::size_t> pairs{0, 0, 1, 1, 2, 2, 3, 3};
        EXPECT_NEAR(f_d2_partner_excluded(axes, pairs).value(), expected["Fd2_partner_excluded"].template get<double>(), tolerance);
        EXPECT_TRUE(parity_equations_without_partners(axes, pairs).isApprox(matrix_of(expected["V_npar_partner_excluded"]), tolerance));
    });
}

TEST(ReferenceCases, triads)
{
    for_each_case("triads", [](const auto& one, const Axes& axes, double tolerance) {
        const AxisVector z = vector_of(one["input"]["quasi_coordinates"]);
        const auto& expected = one["expected"];
        const auto all = triads(axes);
        ASSERT_EQ(all.size(), 4U);
        for (std::size_t k = 0; k < 4; ++k) {
            const Eigen::Vector3d body = all[k].body(z);
            EXPECT_LT((body - Eigen::Vector3d(vector_of(expected["triad_body"][k]))).norm(), tolerance) << "triad " << k;
            EXPECT_NEAR(body.norm(), expected["triad_modulus"][k].template get<double>(), tolerance) << "triad " << k;
        }
        EXPECT_LT((least_squares_inverse(axes).value() * z - vector_of(expected["ls_body"])).norm(), tolerance);
        const AxisMatrix v = ParitySpace(axes).basis();
        const double sign = v(0, 3) > 0 ? 1 : -1;
        EXPECT_NEAR(sign * ParitySpace(axes).vector(z)(0), expected["parity_unit_v4positive"].template get<double>(), tolerance);
    });
}

TEST(ReferenceCases, potter_suman_glr)
{
    for_each_case("potter_suman_glr", [](const auto& one, const Axes& axes, double tolerance) {
        const ParitySpace space(axes);
        const AxisVector z = vector_of(one["input"]["m"]), parity = space.vector(z);
        const auto& expected = one["expected"];
        EXPECT_NEAR(parity.squaredNorm(), expected["sse"].template get<double>(), tolerance);
        AxisVector explained(axes.rows());
        for (Eigen::Index axis = 0; axis < axes.rows(); ++axis) explained(axis) = space.explained_by(axis, parity);
        EXPECT_LT((explained - vector_of(expected["glr"])).norm(), tolerance);
        const auto culprit = expected["isolated_1based"].template get<Eigen::Index>() - 1;
        EXPECT_DOUBLE_EQ(explained.maxCoeff(), explained(culprit));
        EXPECT_NEAR(space.fault_estimate(culprit, parity), expected["bias_estimate"].template get<double>(), tolerance);
        EXPECT_LT((parity_equations(space) * z - vector_of(expected["p_n"])).norm(), tolerance);
    });
}

}  // namespace
}  // namespace quorient::geometry
