#include "quorient/design/recognise.hpp"

#include "quorient/geometry/layouts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr Index most_recognised = 8;
constexpr Index most_turned = 12;
constexpr double same_number = 1e-6;
constexpr double turn_rounding = 1e-12;  // turning leaves this in a component
constexpr double same_line = 1e-6;  // length of the cross product

/// |cosines| of all pairs and |volumes| of all triads, sorted: what a turn, a change of signs or of order leaves alone.
std::vector<double> fingerprint(const geometry::Axes& axes)
{
    std::vector<double> cosines, volumes;
    for (Index i = 0; i < axes.rows(); ++i)
        for (Index j = i + 1; j < axes.rows(); ++j) {
            cosines.push_back(std::abs(axes.row(i).dot(axes.row(j))));
            for (Index k = j + 1; k < axes.rows(); ++k) {
                const Vector3d a = axes.row(i), b = axes.row(j), c = axes.row(k);
                volumes.push_back(std::abs(a.cross(b).dot(c)));
            }
        }
    std::ranges::sort(cosines);
    std::ranges::sort(volumes);
    cosines.insert(cosines.end(), volumes.begin(), volumes.end());
    return cosines;
}

bool on_a_line(const Vector3d& line, const geometry::Axes& axes)
{
    for (Index axis = 0; axis < axes.rows(); ++axis)
        if (line.cross(axes.row(axis).transpose()).norm() < same_line) return true;
    return false;
}

bool maps_on_itself(const geometry::Axes& axes, const Matrix3d& turn)
{
    for (Index axis = 0; axis < axes.rows(); ++axis)
        if (!on_a_line(turn * axes.row(axis).transpose(), axes)) return false;
    return true;
}

unsigned symmetry_about(const geometry::Axes& axes, const Vector3d& direction)
{
    for (auto order = static_cast<unsigned>(axes.rows()); order >= 2; --order)
        if (maps_on_itself(axes, Eigen::AngleAxisd(2 * std::numbers::pi / order, direction).toRotationMatrix())) return order;
    return 1;
}

/// Where an axis of symmetry can be: along an axis, between two, or as far from three (each as a line: either sign).
std::vector<Vector3d> candidates(const geometry::Axes& axes)
{
    std::vector<Vector3d> list;
    const auto add = [&](const Vector3d& direction) {
        if (direction.norm() > same_line) list.push_back(direction.normalized());
    };
    for (Index i = 0; i < axes.rows(); ++i) add(axes.row(i));
    for (Index i = 0; i < axes.rows(); ++i)
        for (Index j = i + 1; j < axes.rows(); ++j)
            for (const double sign : {1.0, -1.0}) {
                const Vector3d a = axes.row(i), b = sign * axes.row(j);
                add(a + b);
                for (Index k = j + 1; k < axes.rows(); ++k)
                    for (const double other : {1.0, -1.0}) {
                        const Vector3d c = other * axes.row(k);
                        add(a.cross(b) + b.cross(c) + c.cross(a));
                    }
            }
    return list;
}

/// z along the direction; of the axes beside it the first one at azimuth 0.
Matrix3d turn_to_z(const geometry::Axes& axes, const Vector3d& direction)
{
    Vector3d beside = direction.unitOrthogonal();
    for (Index axis = 0; axis < axes.rows(); ++axis) {
        const Vector3d across = axes.row(axis).transpose() - axes.row(axis).dot(direction) * direction;
        if (across.norm() < same_line) continue;
        beside = across.normalized();
        break;
    }
    Matrix3d turn;
    turn.row(0) = beside;
    turn.row(2) = direction;
    turn.row(1) = direction.cross(beside);
    return turn;
}

/// Upper half of space, sorted from z down and by azimuth.
geometry::Axes tidied(geometry::Axes axes)
{
    constexpr double on_plane = 1e-9;
    std::vector<Vector3d> rows;
    for (Index axis = 0; axis < axes.rows(); ++axis) {
        Vector3d row = axes.row(axis);
        const bool down = row.z() < -on_plane ||
                          (std::abs(row.z()) <= on_plane && (row.x() < -on_plane || (std::abs(row.x()) <= on_plane && row.y() < 0)));
        rows.push_back(down ? Vector3d(-row) : row);
    }
    const auto place = [](const Vector3d& row) {
        double azimuth = std::atan2(row.y(), row.x());
        if (azimuth < -on_plane) azimuth += 2 * std::numbers::pi;
        return std::pair(-std::round(row.z() / on_plane / 100), std::hypot(row.x(), row.y()) < on_plane ? 0 : azimuth);
    };
    std::ranges::sort(rows, {}, place);
    for (Index axis = 0; axis < axes.rows(); ++axis) axes.row(axis) = rows[static_cast<std::size_t>(axis)];
    return axes;
}

}  // namespace

std::string same_as(const geometry::Axes& axes)
{
    if (axes.rows() > most_recognised) return {};
    const auto own = fingerprint(axes);
    std::vector<std::string> names;
    for (const geometry::CatalogueEntry& entry : geometry::catalogue()) names.push_back(entry.name);
    for (const char* family : {"cone-", "cone-axis-"}) names.push_back(family + std::to_string(axes.rows()));
    for (const std::string& name : names) {
        const auto known = geometry::layout(name);
        if (!known || known->axes.rows() != axes.rows()) continue;
        if (std::ranges::equal(own, fingerprint(known->axes), [](double a, double b) { return std::abs(a - b) < same_number; })) return name;
    }
    return {};
}

Upright upright(const geometry::Axes& axes, bool single)
{
    Vector3d best = axes.row(0);
    unsigned order = 1;
    if (axes.rows() <= most_turned)
        for (const Vector3d& direction : candidates(axes)) {
            const unsigned found = symmetry_about(axes, direction);
            if (found <= order) continue;
            order = found;
            best = direction;
        }
    geometry::Axes turned = axes * turn_to_z(axes, best).transpose();
    turned = turned.unaryExpr([](double part) { return std::abs(part) < turn_rounding ? 0 : part; });
    return {single ? tidied(turned) : turned, order};
}

}  // namespace quorient::design
