// Every derivative that the search relies on, against differences of the values.

#include "../src/arrangement.hpp"
#include "../src/terms.hpp"
#include "briefs.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gtest/gtest.h>
#include <functional>
#include <limits>
#include <random>

namespace quorient::design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double step = 1e-6;
constexpr double close = 1e-7;

MatrixXd differences(const std::function<VectorXd(const VectorXd&)>& values, const VectorXd& x)
{
    MatrixXd all(values(x).size(), x.size());
    for (Index k = 0; k < x.size(); ++k) {
        VectorXd before = x, after = x;
        before(k) -= step;
        after(k) += step;
        all.col(k) = (values(after) - values(before)) / (2 * step);
    }
    return all;
}

geometry::Axes as_axes(const VectorXd& flat)
{
    return Eigen::Map<const Eigen::MatrixXd>(flat.data(), flat.size() / 3, 3);
}

VectorXd flat(const geometry::Axes& axes)
{
    const Eigen::MatrixXd copy = axes;
    return Eigen::Map<const VectorXd>(copy.data(), copy.size());
}

/// Skewed, so that nothing vanishes by symmetry.
geometry::Axes skewed()
{
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    geometry::Axes axes(6, 3);
    for (Index axis = 0; axis < 6; ++axis) axes.row(axis) = Eigen::RowVector3d(normal(random), normal(random), normal(random)).normalized();
    return axes;
}

void expect_right(const std::function<Terms(const geometry::Axes&)>& terms)
{
    const geometry::Axes axes = skewed();
    const MatrixXd numeric = differences([&](const VectorXd& x) { return terms(as_axes(x)).value; }, flat(axes));
    const Terms found = terms(axes);
    EXPECT_LT((found.gradient - numeric).cwiseAbs().maxCoeff() / numeric.cwiseAbs().maxCoeff(), close);
}

TEST(Derivatives, of_accuracies_with_and_without_failures_are_right)
{
    const std::vector<AxisMask> removed{0, 0b1, 0b100001};
    expect_right([&](const geometry::Axes& axes) { return trace_terms(axes, removed); });
    expect_right([&](const geometry::Axes& axes) { return volume_terms(axes, removed); });
    expect_right([](const geometry::Axes& axes) { return anisotropy_terms(axes); });
}

TEST(Derivatives, of_angles_and_of_what_faults_show_are_right)
{
    const std::vector<AxisPair> pairs{{0, 1}, {2, 5}};
    expect_right([&](const geometry::Axes& axes) { return cosine_terms(axes, pairs); });
    expect_right([](const geometry::Axes& axes) { return visibility_terms(axes); });
    expect_right([](const geometry::Axes& axes) { return rivalry_terms(axes); });
}

void expect_right(const Brief& brief, const std::vector<Stand>& stands)
{
    std::mt19937_64 random(3);
    Arrangement arrangement(brief.kept, brief.axes_each, stands);
    const VectorXd x = arrangement.draw(random);
    ASSERT_GT(x.size(), 0);
    for (const VectorXd& at : {x, VectorXd(x + VectorXd::Constant(x.size(), 0.3))}) {
        const MatrixXd numeric = differences([&](const VectorXd& y) { return flat(arrangement.axes(y)); }, at);
        EXPECT_LT((arrangement.derivative(at) - numeric).cwiseAbs().maxCoeff(), close);
        const MatrixXd tilts = differences([&](const VectorXd& y) { return arrangement.tilt_excess(y); }, at);
        if (tilts.rows() > 0) {
            EXPECT_LT((arrangement.tilt_excess_derivative(at) - tilts).cwiseAbs().maxCoeff(), close);
        }
        for (Index axis = 0; axis < arrangement.axis_count(); ++axis) EXPECT_NEAR(arrangement.axes(at).row(axis).norm(), 1, 1e-14);
    }
}

TEST(Derivatives, of_every_mounting_are_right)
{
    std::vector<Brief> briefs{single_axes(3), triads(2), single_axes(4, ConeMounting{}), triads(2, ConeMounting{}),
                              single_axes(7, SymmetricMounting{Eigen::Vector3d(1, 2, 3).normalized(), 3}),
                              single_axes(5, SymmetricMounting{Eigen::Vector3d::UnitX(), 2})};
    briefs[0].kept = geometry::layout("orthogonal-3")->axes;
    for (const Brief& brief : briefs)
        for (const auto& stands : choices(brief).stands) expect_right(brief, stands);
    const Brief faces = triads(2, FaceMounting{{Face{.normal = Eigen::Vector3d(0, 0.6, 0.8), .tolerance_rad = 0.1}}});
    const Brief wedges = triads(2, WedgeMounting{{0.5}, {}, {}});
    for (const Brief& brief : {faces, wedges}) {
        const Place place = choices(brief).places.front();
        expect_right(brief, {Stand{place}, Stand{place}});
    }
}

TEST(Places, of_two_and_three_axes_on_a_cone_have_all_of_them_on_it)
{
    for (const auto& [axes_each, half_angle_deg] : {std::pair(2U, 50.0), std::pair(2U, 70.0), std::pair(3U, 54.7356103172)}) {
        Brief brief = single_axes(2, ConeMounting{half_angle_deg * degree});
        brief.axes_each = axes_each;
        std::mt19937_64 random(1);
        Arrangement arrangement({}, axes_each, choices(brief).stands.front());
        const geometry::Axes axes = arrangement.axes(arrangement.draw(random));
        for (Index axis = 0; axis < axes.rows(); ++axis) EXPECT_NEAR(axes(axis, 2), std::cos(half_angle_deg * degree), 1e-9);
        EXPECT_NEAR(axes.row(0).dot(axes.row(1)), 0, 1e-12);
    }
}

TEST(Places, at_right_angles_are_three_for_an_axis_and_one_for_a_triad)
{
    EXPECT_EQ(choices(single_axes(4, RightAngleMounting{})).places.size(), 3U);
    EXPECT_EQ(choices(triads(4, RightAngleMounting{})).places.size(), 1U);
    Brief pairs = single_axes(3, RightAngleMounting{});
    pairs.axes_each = 2;
    EXPECT_EQ(choices(pairs).places.size(), 3U);
}

TEST(Places, on_wedges_are_counted_once_each)
{
    const std::vector<double> quarters{0, 90 * degree, 180 * degree, 270 * degree};
    EXPECT_EQ(choices(single_axes(4, WedgeMounting{{0, 30 * degree}, quarters, quarters})).places.size(), 5U);  // flat, and four ways to lean
    EXPECT_EQ(choices(triads(4, WedgeMounting{{0, 30 * degree}, quarters, quarters})).places.size(), 5U);      // quarter turns keep a triad's lines
    EXPECT_EQ(choices(triads(4, WedgeMounting{{0, 30 * degree}, quarters, {0, 45 * degree}})).places.size(), 10U);
}

}  // namespace
}  // namespace quorient::design
