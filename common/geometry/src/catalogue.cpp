#include "catalogue.hpp"

#include "families.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

namespace quorient::geometry {

namespace {

using std::numbers::inv_sqrt3;
using std::numbers::pi;
using std::numbers::sqrt2;
using std::numbers::sqrt3;

const double sqrt5 = std::sqrt(5.0);
const double sqrt6 = std::sqrt(6.0);
const double half_sqrt2 = sqrt2 / 2;
const double golden_cosine = std::sqrt((5 + sqrt5) / 10);  // cos(atan(2) / 2): the dodecahedron's face normals
const double golden_sine = std::sqrt((5 - sqrt5) / 10);

template <std::size_t Count>
Axes rows(const std::array<Eigen::RowVector3d, Count>& list)
{
    Axes axes(Count, 3);
    for (std::size_t row = 0; row < Count; ++row) axes.row(static_cast<Eigen::Index>(row)) = list[row];
    return axes;
}

Axes orthogonal_3()
{
    return Eigen::Matrix3d::Identity();
}

Axes orthogonal_3_plus_1()
{
    Axes axes(4, 3);
    axes << Eigen::Matrix3d::Identity(), inv_sqrt3, inv_sqrt3, inv_sqrt3;
    return axes;
}

Axes cone_4()
{
    Axes axes(4, 3);
    axes << 1, -1, 1, -1, -1, 1, -1, 1, 1, 1, 1, 1;
    return axes / sqrt3;
}

Axes cone_3_axis()
{
    return rows<4>({{{2 * sqrt2 / 3, 0, 1.0 / 3}, {-sqrt2 / 3, -sqrt2 / sqrt3, 1.0 / 3}, {-sqrt2 / 3, sqrt2 / sqrt3, 1.0 / 3}, {0, 0, 1}}});
}

Axes tetrad()
{
    Axes axes(4, 3);
    axes << -1, 1, -1, 1, 1, -1, 1, -1, -1, -1, -1, -1;
    return axes / sqrt3;
}

Axes tetrad_2()
{
    Axes axes(4, 3);
    axes << 0, sqrt2, -1, sqrt2, 0, -1, 0, -sqrt2, -1, -sqrt2, 0, -1;
    return axes / sqrt3;
}

/// H7 is the regular five-cone c_k, tilted about y until c_2 and c_3 lie in the plane x = 0, in the order and with the signs
/// c_0, -c_1, c_2, c_3, -c_4. The x of c_2 is sqrt(2/3) cos(144 deg) cos(tilt) + sin(tilt)/sqrt(3), hence the tilt.
Axes cone_5()
{
    const double tilt = std::atan(-sqrt2 * std::cos(4 * pi / 5));
    Axes axes = cone(5, inv_sqrt3) * Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix().transpose();
    axes.row(1) *= -1;
    axes.row(4) *= -1;
    axes(0, 1) = axes(2, 0) = axes(3, 0) = 0;
    return axes;
}

/// The decimals of the paper: two rows are 6e-6 off unit norm, and are used so.
Axes cone_5_printed()
{
    return rows<5>({{{0.97204, 0, -0.23482},
                     {-0.60075, -0.77653, -0.18997},
                     {0, 0.47992, 0.87731},
                     {0, -0.47992, 0.87731},
                     {-0.60075, 0.77653, -0.18997}}});
}

Axes cone_6()
{
    return cone(6, inv_sqrt3);
}

Axes dodecahedron()
{
    const double c = golden_cosine, s = golden_sine;
    return rows<6>({{{c, s, 0}, {c, -s, 0}, {0, c, s}, {0, c, -s}, {s, 0, c}, {-s, 0, c}}});
}

Axes dodecahedron_h1()
{
    const double c = golden_cosine, s = golden_sine;
    return rows<6>({{{s, c, 0}, {0, s, c}, {c, 0, s}, {-s, c, 0}, {0, -s, c}, {c, 0, -s}}});
}

Axes dodecahedron_h2()
{
    const double c = golden_cosine, s = golden_sine;
    return rows<6>({{{s, 0, c}, {-s, 0, c}, {c, s, 0}, {c, -s, 0}, {0, c, s}, {0, c, -s}}});
}

Axes octahedron_6()
{
    const double h = half_sqrt2;
    return rows<6>({{{h, 0, h}, {-h, 0, h}, {h, h, 0}, {h, -h, 0}, {0, h, h}, {0, h, -h}}});
}

Axes octahedron_8()
{
    const double a = half_sqrt2, b = 1 / sqrt6, c = inv_sqrt3;
    return rows<8>({{{a, -b, c}, {a, b, -c}, {b, a, c}, {-b, a, -c}, {-a, b, c}, {-a, -b, -c}, {-b, -a, c}, {b, -a, -c}}});
}

Axes tdof_symmetric()
{
    const double p = sqrt3 + 1, m = sqrt3 - 1;
    Axes axes(8, 3);
    axes << p, -m, 2, -m, p, 2, m, p, 2, -p, -m, 2, -p, m, 2, m, -p, 2, -m, -p, 2, p, m, 2;
    return axes / (2 * sqrt3);
}

Axes tdof_orthogonal()
{
    const double h = half_sqrt2;
    return rows<8>({{{0, 0, 1}, {-h, -h, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}}});
}

/// Axis 7 as printed would repeat axis 5; (-1/2, -1/2, 1/sqrt 2) completes the symmetry and gives the paper's own Table 3.
Axes tdof_coplanar()
{
    const double h = half_sqrt2;
    return rows<8>({{{-h, 0, h}, {h, 0, h}, {0, h, h}, {0, -h, h}, {-.5, .5, h}, {.5, -.5, h}, {.5, .5, h}, {-.5, -.5, h}}});
}

Axes guaranteed_cone()
{
    const double s = std::sqrt(2.0 / 3), c = inv_sqrt3, t = sqrt3 / 2;
    return rows<6>({{{-c, -s, 0}, {c, s / 2, -t * s}, {-c, s / 2, t * s}, {c, -s, 0}, {-c, s / 2, -t * s}, {c, s / 2, t * s}}});
}

const std::vector<std::size_t> four_two_axis_gyros{0, 0, 1, 1, 2, 2, 3, 3};

}  // namespace

const std::vector<NamedLayout>& named_layouts()
{
    static const std::vector<NamedLayout> layouts{
        {"orthogonal-3", "004 H4: the body axes, no redundancy", orthogonal_3},
        {"orthogonal-3-plus-1", "003 (11): the body axes and their diagonal", orthogonal_3_plus_1},
        {"cone-4", "003 (20)", cone_4},
        {"cone-3-axis", "003 (29): three on a cone, one along its axis: tetrahedron", cone_3_axis},
        {"tetrad", "004 H5", tetrad},
        {"tetrad-2", "004 H6", tetrad_2},
        {"cone-5", "004 H7, exact", cone_5},
        {"cone-5-printed", "004 H7, the printed decimals", cone_5_printed},
        {"cone-6", "002: two orthogonal triads on a cone", cone_6},
        {"dodecahedron", "002: normals of the faces", dodecahedron},
        {"dodecahedron-h1", "004 H1", dodecahedron_h1},
        {"dodecahedron-h2", "004 H2", dodecahedron_h2},
        {"octahedron-6", "004 H3: along the edges", octahedron_6},
        {"octahedron-8", "004 H8: two in every face", octahedron_8},
        {"tdof-symmetric", "004 H9: four two-axis gyros", tdof_symmetric, four_two_axis_gyros},
        {"tdof-orthogonal", "004 H10: four two-axis gyros", tdof_orthogonal, four_two_axis_gyros},
        {"tdof-coplanar", "004 H11: four two-axis gyros, axis 7 corrected", tdof_coplanar, four_two_axis_gyros},
        {"guaranteed-cone", "000: cone-6 around x, in the paper's order and signs", guaranteed_cone},
    };
    return layouts;
}

}  // namespace quorient::geometry
