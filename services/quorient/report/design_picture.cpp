#include "design_picture.hpp"

#include "cli/svg_plot.hpp"
#include "quorient/geometry/parity_space.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace quorient::cli {

namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double panel = 420;
constexpr double radius = 150;
constexpr double header = 40;

struct Panel {
    double left, top;
    Vector2d centre() const { return {left + panel / 2, top + header + radius + 20}; }
};

/// Two directions of the page in space: right and up.
struct View {
    Vector3d right, up, towards;
    Vector2d place(const Vector3d& point, const Vector2d& centre) const
    {
        return centre + radius * Vector2d(right.dot(point), -up.dot(point));
    }
};

View from_direction(const Vector3d& towards)
{
    const Vector3d right = Vector3d::UnitZ().cross(towards).normalized();
    return {right, towards.cross(right), towards};
}

View along_z()
{
    return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
}

void title(std::string& svg, const Panel& at, const std::string& text)
{
    fmt::format_to(std::back_inserter(svg), "<text x='{:.1f}' y='{:.1f}' font-size='14'>{}</text>\n", at.left + 16, at.top + 24, text);
}

void line(std::string& svg, const Vector2d& from, const Vector2d& to, const std::string& style)
{
    fmt::format_to(std::back_inserter(svg), "<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' {}/>\n", from.x(), from.y(), to.x(), to.y(), style);
}

void label(std::string& svg, const Vector2d& at, const std::string& text, const std::string& style)
{
    fmt::format_to(std::back_inserter(svg), "<text x='{:.1f}' y='{:.1f}' text-anchor='middle' {}>{}</text>\n", at.x(), at.y() + 4, style, text);
}

/// Directions as arrows from the centre of a sphere, each with its number; those that point away from the reader are thinner.
void draw_directions(std::string& svg, const Panel& at, const View& view, const Eigen::MatrixX3d& directions, const std::vector<std::size_t>& group,
                     const std::array<const char*, 3>& names)
{
    const Vector2d centre = at.centre();
    fmt::format_to(std::back_inserter(svg), "<circle cx='{:.1f}' cy='{:.1f}' r='{}' fill='#fafafa' stroke='#ccc'/>\n", centre.x(),
                   centre.y(), radius);
    for (Index part = 0; part < 3; ++part) {
        const Vector2d tip = view.place(Vector3d::Unit(part), centre);
        if ((tip - centre).norm() < 1) continue;
        line(svg, centre, tip, "stroke='#bbb' stroke-dasharray='3 3'");
        label(svg, centre + 1.07 * (tip - centre), names[static_cast<std::size_t>(part)], "fill='#999'");
    }
    for (Index axis = 0; axis < directions.rows(); ++axis) {
        const Vector3d direction = directions.row(axis);
        const Vector2d tip = view.place(direction, centre);
        const std::string ink = colour(group[static_cast<std::size_t>(axis)]);
        const bool away = view.towards.dot(direction) < -1e-9;
        line(svg, centre, view.place(-direction, centre), fmt::format("stroke='{}' stroke-width='0.6' stroke-opacity='0.4'", ink));
        line(svg, centre, tip, fmt::format("stroke='{}' stroke-width='{}'", ink, away ? 1.2 : 2.2));
        fmt::format_to(std::back_inserter(svg), "<circle cx='{:.1f}' cy='{:.1f}' r='9' fill='white' stroke='{}'/>\n", tip.x(), tip.y(), ink);
        label(svg, tip, std::to_string(axis), fmt::format("font-size='11' fill='{}'", ink));
    }
}

/// Columns of V in two or three dimensions, of unit length.
Eigen::MatrixX3d parity_directions(const geometry::ParitySpace& space)
{
    Eigen::MatrixX3d directions = Eigen::MatrixX3d::Zero(space.size(), 3);
    for (Index axis = 0; axis < space.size(); ++axis)
        if (space.sees(axis)) directions.row(axis).head(space.redundancy()) = space.basis().col(axis).normalized().transpose();
    return directions;
}

/// |cosine| of the parity directions of every two axes: 1 = a fault of one looks like a fault of the other.
void draw_likeness(std::string& svg, const Panel& at, const geometry::ParitySpace& space)
{
    title(svg, at, "How alike faults look (|cosine| in parity space)");
    const Index n = space.size();
    const double side = 2 * radius / static_cast<double>(n);
    const auto& p = space.projector();
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            const bool seen = space.sees(i) && space.sees(j);
            const double likeness = seen ? std::min(1.0, std::abs(p(i, j)) / std::sqrt(p(i, i) * p(j, j))) : 0;
            const auto grey = static_cast<int>(std::lround(255 - 175 * likeness));
            const double x = at.left + 70 + side * static_cast<double>(j), y = at.top + header + 10 + side * static_cast<double>(i);
            fmt::format_to(std::back_inserter(svg),
                           "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='rgb({},{},255)' stroke='white'/>\n", x, y,
                           side, side, grey, grey);
            if (n <= 12)
                label(svg, {x + side / 2, y + side / 2}, seen ? fmt::format("{:.2f}", likeness) : "-",
                      fmt::format("font-size='{:.0f}'", std::clamp(side / 3, 7.0, 12.0)));
        }
    for (Index i = 0; i < n; ++i) {
        const double step = side * (static_cast<double>(i) + 0.5);
        label(svg, {at.left + 56, at.top + header + 10 + step}, std::to_string(i), "font-size='10'");
        label(svg, {at.left + 70 + step, at.top + header + 22 + 2 * radius}, std::to_string(i), "font-size='10'");
    }
}

void draw_parity(std::string& svg, const Panel& at, const geometry::ParitySpace& space, const std::vector<std::size_t>& group)
{
    const Index q = space.redundancy();
    if (q == 2 || q == 3) {
        title(svg, at, fmt::format("Where faults show in parity space ({} dimensions)", q));
        const View view = q == 2 ? along_z() : from_direction(Vector3d(2, 1, 1).normalized());
        draw_directions(svg, at, view, parity_directions(space), group, {"p0", "p1", "p2"});
        return;
    }
    title(svg, at, "Where faults show in parity space");
    const std::string why = q == 0   ? "no axis is redundant: no fault shows"
                            : q == 1 ? "one parity equation: all faults show alike"
                                     : fmt::format("{} dimensions: see the matrix beside", q);
    label(svg, at.centre(), why, "fill='#555'");
}

}  // namespace

std::string array_picture(const geometry::SensorCluster& cluster, const std::string& name)
{
    const bool single = std::ranges::max(cluster.instrument) + 1 == cluster.size();
    std::vector<std::size_t> group = cluster.instrument;
    const Eigen::MatrixX3d axes = cluster.axes;
    constexpr std::array body{"x", "y", "z"};
    const geometry::ParitySpace space(cluster.axes);
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' font-family='sans-serif' font-size='12'>\n"
        "<rect width='{0}' height='{1}' fill='white'/>\n<text x='16' y='22' font-size='16'>{2}</text>\n",
        2 * panel, 2 * panel + header - 20, name);
    const Panel side{0, 20}, top{panel, 20}, parity{0, panel + 10}, likeness{panel, panel + 10};
    title(svg, side, single ? "Axes, from the side" : "Axes, from the side (a colour for each instrument)");
    draw_directions(svg, side, from_direction(Vector3d(2, 1, 1).normalized()), axes, group, body);
    title(svg, top, "Axes, along z");
    draw_directions(svg, top, along_z(), axes, group, body);
    draw_parity(svg, parity, space, group);
    draw_likeness(svg, likeness, space);
    return svg + "</svg>\n";
}

}  // namespace quorient::cli
