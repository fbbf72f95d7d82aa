#include "rotation.hpp"

#include "matrix.hpp"
#include "quorient/configuration/values.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/rotation/nearest.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace quorient::system {

using namespace configuration;

namespace {

using Quaternion = std::array<double, 4>;

constexpr double tolerance = 1e-3;

/// The last digits of a quaternion that somebody normalised already are left as they are.
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

Quaternion to_array(const Eigen::Quaterniond& q)
{
    return {q.w(), q.x(), q.y(), q.z()};
}

std::optional<Quaternion> read_quaternion(Section& section, const std::string& key)
{
    std::vector<double> numbers;
    section.numbers(key, numbers);
    if (numbers.size() != section.raw(key).size()) return std::nullopt;  // reported at the entry
    if (numbers.size() != 4) {
        section.problem(key, fmt::format("expected a {}", rotation_form));
        return std::nullopt;
    }
    Eigen::Map<Eigen::Vector4d> q(numbers.data());
    const double norm = q.norm();
    if (!(std::abs(norm - 1) <= tolerance)) {
        section.problem(key, fmt::format("expected a unit quaternion [w, x, y, z], its norm is {}", norm));
        return std::nullopt;
    }
    if (std::abs(norm - 1) > rounding) q /= norm;
    return Quaternion{q(0), q(1), q(2), q(3)};
}

/// What makes these rows no rotation; empty if they are one.
std::string not_a_rotation(const Eigen::Matrix3d& rows)
{
    for (Eigen::Index row = 0; row < 3; ++row)
        if (const double norm = rows.row(row).norm(); !(std::abs(norm - 1) <= tolerance))
            return fmt::format("row {} is no unit vector, its norm is {}", row, norm);
    for (Eigen::Index row = 0; row < 3; ++row) {
        const Eigen::Index next = (row + 1) % 3;
        if (const double product = rows.row(row).dot(rows.row(next)); !(std::abs(product) <= tolerance))
            return fmt::format("rows {} and {} are not perpendicular, their product is {}", row, next, product);
    }
    return rows.determinant() > 0 ? "" : "the rows are a reflection, not a rotation: their determinant is -1";
}

std::optional<Quaternion> read_rows(Section& section, const std::string& key)
{
    Eigen::MatrixXd rows;
    if (!read_matrix(section, key, rows)) return std::nullopt;
    const auto wrong = rows.rows() == 3 && rows.cols() == 3 ? not_a_rotation(rows) : "expected three rows of three numbers";
    if (!wrong.empty()) {
        section.problem(key, wrong);
        return std::nullopt;
    }
    return to_array(Eigen::Quaterniond(rotation::nearest_rotation(rows)).normalized());
}

std::optional<Quaternion> read_angles(Section& section, const std::string& key)
{
    Section angles = section.section(key);
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    double roll_deg = nothing, pitch_deg = nothing, yaw_deg = nothing;
    for (const char* angle : {"roll_deg", "pitch_deg", "yaw_deg"}) angles.require(angle);
    angles.number("roll_deg", roll_deg, {}, "deg");
    angles.number("pitch_deg", pitch_deg, {}, "deg");
    angles.number("yaw_deg", yaw_deg, {}, "deg");
    angles.finish();
    if (std::isnan(roll_deg + pitch_deg + yaw_deg)) return std::nullopt;
    const auto about = [](double angle_deg, const Eigen::Vector3d& axis) { return Eigen::AngleAxisd(angle_deg * degree, axis); };
    return to_array(about(yaw_deg, Eigen::Vector3d::UnitZ()) * about(pitch_deg, Eigen::Vector3d::UnitY()) *
                    about(roll_deg, Eigen::Vector3d::UnitX()));
}

}  // namespace

std::optional<Quaternion> read_rotation(Section& section, const std::string& key)
{
    if (!section.has(key)) return std::nullopt;
    const YAML::Node node = section.raw(key);
    if (node.IsMap()) return read_angles(section, key);
    if (node.IsSequence() && node.size() > 0 && node[0].IsSequence()) return read_rows(section, key);
    return read_quaternion(section, key);
}

YAML::Node rotation_node(const Quaternion& rotation)
{
    return to_node(std::vector<double>(rotation.begin(), rotation.end()));
}

}  // namespace quorient::system
