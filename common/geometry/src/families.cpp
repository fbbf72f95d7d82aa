#include "families.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <numbers>

namespace quorient::geometry {

namespace {

using Result = tl::expected<SensorCluster, std::string>;

constexpr double radian_per_degree = std::numbers::pi / 180;

template <class Number>
std::optional<Number> number(std::string_view text)
{
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// `count` finite numbers, separated by commas.
std::optional<std::vector<double>> numbers(std::string_view text, std::size_t count)
{
    std::vector<double> values;
    while (values.size() < count) {
        const std::size_t comma = text.find(',');
        const auto value = number<double>(text.substr(0, comma));
        if (!value || !std::isfinite(*value)) return std::nullopt;
        values.push_back(*value);
        if (comma == std::string_view::npos) break;
        text.remove_prefix(comma + 1);
        if (values.size() == count) return std::nullopt;
    }
    if (values.size() < count) return std::nullopt;
    return values;
}

Eigen::RowVector3d on_cone(double azimuth_rad, double cosine)
{
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine};
}

Result cone_of(Eigen::Index count)
{
    return make_cluster(cone(count, std::numbers::inv_sqrt3));
}

/// H'H = n/3 I needs (n - 1) cos^2 + 1 = (n - 1) sin^2 / 2, hence the half-angle.
Result cone_with_axis(Eigen::Index count)
{
    const auto n = static_cast<double>(count);
    Axes axes(count, 3);
    axes << cone(count - 1, std::sqrt((n - 3) / (3 * (n - 1)))), 0, 0, 1;
    return make_cluster(axes);
}

Result two_cones(const std::vector<double>& degrees)
{
    Axes axes(6, 3);
    for (int k = 0; k < 3; ++k) {
        const double azimuth_rad = 120 * k * radian_per_degree;
        axes.row(k) = on_cone(azimuth_rad, std::sin(degrees[0] * radian_per_degree));
        axes.row(3 + k) = on_cone(azimuth_rad + degrees[2] * radian_per_degree, std::sin(degrees[1] * radian_per_degree));
    }
    return make_cluster(axes);
}

Result two_triads(const std::vector<double>& parameter)
{
    const Eigen::Vector3d direction(parameter[0], parameter[1], parameter[2]);
    if (direction.norm() == 0) return tl::unexpected(std::string("two-triads: the axis of rotation has no length"));
    Axes axes(6, 3);
    axes << Eigen::Matrix3d::Identity(),
        Eigen::AngleAxisd(parameter[3] * radian_per_degree, direction.normalized()).toRotationMatrix().transpose();
    return make_cluster(axes, {0, 0, 0, 1, 1, 1});
}

Result aligned_triads(Eigen::Index count)
{
    std::vector<std::size_t> instrument;
    for (std::size_t axis = 0; axis < 3 * static_cast<std::size_t>(count); ++axis) instrument.push_back(axis / 3);
    return make_cluster(Axes(Eigen::Matrix3d::Identity().replicate(count, 1)), std::move(instrument));
}

Result counted(std::string_view name, std::string_view count_text, int least, int most, Result (*make)(Eigen::Index))
{
    const auto count = number<int>(count_text);
    if (!count || *count < least || *count > most)
        return tl::unexpected(fmt::format("layout '{}': the number must be {}..{}, got '{}'", name, least, most, count_text));
    return make(*count);
}

Result parameterised(std::string_view name, std::string_view text, std::size_t count, std::string_view pattern,
                     Result (*make)(const std::vector<double>&))
{
    const auto values = numbers(text, count);
    if (!values)
        return tl::unexpected(fmt::format("layout '{}': {} numbers separated by commas are needed, as in {}", name, count, pattern));
    return make(*values);
}

}  // namespace

Axes cone(Eigen::Index count, double cosine)
{
    Axes axes(count, 3);
    for (Eigen::Index k = 0; k < count; ++k)
        axes.row(k) = on_cone(2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count), cosine);
    return axes;
}

const std::vector<Family>& families()
{
    static const std::vector<Family> list{
        {"cone-axis-", "cone-axis-N", "002: N - 1 axes on the optimal cone and one along its axis, N = 4..24"},
        {"cone-", "cone-N", "002: N axes on the cone of half-angle acos(1/sqrt 3), N = 3..24"},
        {"two-cones:", "two-cones:A1,A2,D", "002: 3 + 3 axes, A1 and A2 deg above the plane, the second turned by D deg"},
        {"two-triads:", "two-triads:ax,ay,az,deg", "002: the body axes and the same turned about (ax, ay, az), two instruments"},
        {"triads-", "triads-N", "N aligned triads, one instrument each, N = 1..8"},
    };
    return list;
}

std::optional<Result> family_member(std::string_view name)
{
    for (const Family& family : families()) {
        if (!name.starts_with(family.prefix)) continue;
        const std::string_view rest = name.substr(family.prefix.size());
        if (family.prefix == "two-cones:") return parameterised(name, rest, 3, family.pattern, two_cones);
        if (family.prefix == "two-triads:") return parameterised(name, rest, 4, family.pattern, two_triads);
        if (rest != "N" && rest.find_first_not_of("0123456789") != std::string_view::npos) continue;
        if (family.prefix == "cone-axis-") return counted(name, rest, 4, 24, cone_with_axis);
        if (family.prefix == "cone-") return counted(name, rest, 3, 24, cone_of);
        return counted(name, rest, 1, 8, aligned_triads);
    }
    return std::nullopt;
}

}  // namespace quorient::geometry
