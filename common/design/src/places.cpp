#include "places.hpp"

#include "numbers.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace quorient::design {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double parallel = 1e-9;  // limit of 1 - |cosine|

const double diagonal_cone_rad = std::acos(std::numbers::inv_sqrt3);  // half-angle of three right-angled axes around their diagonal

Matrix3d about_z(double angle_rad)
{
    return Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()).toRotationMatrix();
}

Matrix3d about_y(double angle_rad)
{
    return Eigen::AngleAxisd(angle_rad, Vector3d::UnitY()).toRotationMatrix();
}

/// A rotation that takes z to the direction, and x to what is seen of the body's x (y) from there.
Matrix3d standing_on(const Vector3d& normal)
{
    const Vector3d reference = std::abs(normal.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
    Matrix3d base;
    base.col(2) = normal;
    base.col(0) = (reference - reference.dot(normal) * normal).normalized();
    base.col(1) = base.col(2).cross(base.col(0));
    return base;
}

/// The instrument's attitude whose axes all lie on the cone of this half-angle around z.
Matrix3d on_cone(unsigned axes_each, double half_angle_rad)
{
    if (axes_each == 3) return standing_on(Vector3d(1, 1, 1).normalized()).transpose();
    // Two right-angled axes x, y: each at the half-angle from z where (1, 1, c) / |(1, 1, c)| is z, c^2 + 2 = 1 / cos^2.
    const double squared = 1 / std::pow(std::cos(half_angle_rad), 2) - 2;
    return standing_on(Vector3d(1, 1, std::sqrt(std::max(0.0, squared))).normalized()).transpose();
}

Place anywhere_place()
{
    Place place;
    place.tilt_limit_rad = infinity;
    return place;
}

std::vector<Stand> repeated(const Place& place, std::size_t count)
{
    return std::vector<Stand>(count, Stand{place});
}

/// Turning a single axis about itself changes nothing.
Place free_place(unsigned axes_each)
{
    Place place = anywhere_place();
    place.turn_free = axes_each > 1;
    return place;
}

Choices choices_of(const FreeMounting&, const Brief& brief)
{
    return {{repeated(free_place(brief.axes_each), brief.instruments)}, {}};
}

Choices choices_of(const ConeMounting& cone, const Brief& brief)
{
    Place place;
    place.azimuth_free = true;
    if (brief.axes_each == 1) {
        place.lean_rad = cone.half_angle_rad.value_or(diagonal_cone_rad);
        place.lean_shared = !cone.half_angle_rad;
    } else {
        place.inner = on_cone(brief.axes_each, cone.half_angle_rad.value_or(diagonal_cone_rad));
    }
    return {{repeated(place, brief.instruments)}, {}};
}

Choices choices_of(const FaceMounting& mounting, const Brief& brief)
{
    Choices found;
    for (const Face& face : mounting.faces) {
        Place place;
        place.base = standing_on(face.normal);
        place.tilt_limit_rad = face.tolerance_rad;
        place.holds = face.holds;
        place.face = static_cast<std::size_t>(&face - mounting.faces.data());
        place.turn_free = brief.axes_each > 1 && face.turns_rad.empty();
        found.places.push_back(place);
        if (brief.axes_each == 1 || face.turns_rad.empty()) continue;
        found.places.pop_back();
        for (const double turn_rad : face.turns_rad) {
            place.turn_rad = turn_rad;
            found.places.push_back(place);
        }
    }
    return found;
}

Choices choices_of(const RightAngleMounting&, const Brief&)
{
    Choices found;
    for (const Vector3d normal : {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()}) {
        Place place;
        place.base = standing_on(normal);
        found.places.push_back(place);
    }
    return found;
}

Choices choices_of(const WedgeMounting& mounting, const Brief& brief)
{
    const std::vector<double> zero{0};
    const bool turns_matter = brief.axes_each > 1;
    Choices found;
    for (const double angle_rad : mounting.angles_rad)
        for (const double azimuth_rad : mounting.azimuths_rad.empty() ? zero : mounting.azimuths_rad)
            for (const double turn_rad : mounting.turns_rad.empty() || !turns_matter ? zero : mounting.turns_rad) {
                Place place;
                place.lean_rad = angle_rad;
                place.azimuth_rad = azimuth_rad;
                place.turn_rad = turn_rad;
                place.azimuth_free = mounting.azimuths_rad.empty() && angle_rad != 0;
                place.turn_free = mounting.turns_rad.empty() && turns_matter;
                found.places.push_back(place);
            }
    return found;
}

/// Instruments that a symmetric array may hold beside its orbits: they are turned into themselves.
std::vector<Place> own_images(const SymmetricMounting& mounting, unsigned axes_each)
{
    const Matrix3d base = standing_on(mounting.about);
    std::vector<Place> found;
    const auto add = [&](bool azimuth_free, double lean_rad, const Matrix3d& inner) {
        Place place;
        place.base = base;
        place.azimuth_free = azimuth_free;
        place.lean_rad = lean_rad;
        place.inner = inner;
        found.push_back(place);
    };
    const bool quarter_turns = mounting.order == 2 || mounting.order == 4;
    if (axes_each == 1) {
        add(false, 0, Matrix3d::Identity());
        if (mounting.order == 2) add(true, pi / 2, Matrix3d::Identity());
    } else if (quarter_turns) {
        add(true, 0, Matrix3d::Identity());
    } else if (axes_each == 3 && mounting.order == 3) {
        add(true, 0, on_cone(3, diagonal_cone_rad));
    }
    return found;
}

Choices choices_of(const SymmetricMounting& mounting, const Brief& brief)
{
    Stand orbit{free_place(brief.axes_each), {}};
    for (unsigned image = 0; image < mounting.order; ++image)
        orbit.images.push_back(Eigen::AngleAxisd(2 * pi * image / mounting.order, mounting.about).toRotationMatrix());
    const std::vector<Place> own = own_images(mounting, brief.axes_each);
    const std::size_t left = brief.instruments % mounting.order;
    const std::vector<Stand> orbits(brief.instruments / mounting.order, orbit);
    if (left == 0) return {{orbits}, {}};
    Choices found;
    for (const Place& place : own) {
        found.stands.push_back(orbits);
        found.stands.back().insert(found.stands.back().end(), left, Stand{place});
    }
    return found;
}

bool same_lines(const Matrix3d& first, const Matrix3d& second, unsigned axes_each)
{
    const auto own = instrument_axes(axes_each);
    const Matrix3d cosines = (first.transpose() * second).cwiseAbs();
    for (Eigen::Index i = 0; i < own.rows(); ++i) {
        const Vector3d seen = cosines.transpose() * own.row(i).transpose();  // own axes are unit vectors of the instrument's frame
        double nearest = 0;
        for (Eigen::Index j = 0; j < own.rows(); ++j) nearest = std::max(nearest, seen.dot(own.row(j)));
        if (nearest < 1 - parallel) return false;
    }
    return true;
}

Matrix3d nominal(const Place& place)
{
    return attitude(place, Eigen::Vector2d::Zero(), place.azimuth_rad, place.lean_rad, place.turn_rad);
}

/// Places with a limited number of instruments are all kept: each is a place of its own.
void drop_repetitions(std::vector<Place>& places, unsigned axes_each)
{
    std::vector<Place> kept;
    for (const Place& place : places) {
        const bool known = std::ranges::any_of(kept, [&](const Place& earlier) {
            return earlier.fixed() && place.fixed() && earlier.holds >= max_axes && place.holds >= max_axes &&
                   same_lines(nominal(earlier), nominal(place), axes_each);
        });
        if (!known) kept.push_back(place);
    }
    places = std::move(kept);
}

using CheckedMounting = tl::expected<void, std::string>;

CheckedMounting problem(std::string text)
{
    return tl::unexpected(std::move(text));
}

CheckedMounting check_kind(const FreeMounting&, const Brief&)
{
    return {};
}

CheckedMounting check_kind(const ConeMounting& cone, const Brief& brief)
{
    if (!cone.half_angle_rad) return {};
    if (brief.axes_each == 3 && std::abs(*cone.half_angle_rad - diagonal_cone_rad) > 1e-6)
        return problem("a cone of another half-angle than 54.7356 deg: three right-angled axes lie on no other cone around one line");
    if (brief.axes_each == 2 && *cone.half_angle_rad < pi / 4 - 1e-9)
        return problem("a cone of less than 45 deg: two right-angled axes do not lie on it");
    if (brief.axes_each < 3 && brief.kept.rows() == 0 && (std::sin(*cone.half_angle_rad) < 1e-3 || std::cos(*cone.half_angle_rad) < 1e-3))
        return problem("a cone of 0 or 90 deg: all its axes lie on one line or in one plane and measure no rotation about the rest");
    return {};
}

CheckedMounting check_kind(const FaceMounting& mounting, const Brief& brief)
{
    std::size_t room = 0;
    for (const Face& face : mounting.faces) room = std::min<std::size_t>(max_axes, room + face.holds);
    if (mounting.faces.empty()) return problem("no faces to mount on");
    if (room < brief.instruments) {
        const bool one = brief.axes_each == 1;
        const std::string text = std::to_string(brief.instruments) + (one ? " axes" : " instruments") + " on faces that hold " + std::to_string(room);
        return problem(text);
    }
    return {};
}

CheckedMounting check_kind(const RightAngleMounting&, const Brief& brief)
{
    if (brief.minimum_angle_rad > 0 && brief.axis_count() > 3)
        return problem("right angles offer three directions: of more than 3 axes some are parallel, at 0 deg from each other");
    return {};
}

CheckedMounting check_kind(const WedgeMounting& mounting, const Brief&)
{
    if (mounting.angles_rad.empty()) return problem("no wedges to mount on");
    return {};
}

CheckedMounting check_kind(const SymmetricMounting& mounting, const Brief& brief)
{
    if (brief.kept.rows() > 0) return problem("a symmetry of the new axes beside axes that are kept: mount them freely, or keep none");
    const std::size_t left = brief.instruments % mounting.order;
    if (left == 0) return {};
    const bool fits = left == 1 && !own_images(mounting, brief.axes_each).empty();
    if (fits) return {};
    const std::string order = std::to_string(mounting.order);
    return problem(std::to_string(brief.instruments) + (brief.axes_each == 1 ? " axes" : " instruments") + " with a symmetry of order " + order +
                   ": they come in groups of " + order + ", and " +
                   (brief.axes_each == 1 ? "one more may lie on the axis of symmetry" : "none, or one that fits the symmetry, may be left over"));
}

/// All places fixed in one plane, or on one line, measure nothing outside.
CheckedMounting check_directions(const Brief& brief)
{
    if (brief.axes_each > 1) return {};
    const std::vector<Place> places = choices(brief).places;
    if (places.empty() || std::ranges::any_of(places, [](const Place& place) { return !place.fixed(); })) return {};
    Eigen::Matrix3d normal = brief.kept.transpose() * brief.kept;
    for (const Place& place : places) {
        const Vector3d axis = nominal(place).col(2);
        normal += axis * axis.transpose();
    }
    const double flat = Eigen::SelfAdjointEigenSolver<Matrix3d>(normal, Eigen::EigenvaluesOnly).eigenvalues()(0);
    if (flat > geometry::coplanar_tolerance * geometry::coplanar_tolerance) return {};
    return problem("all places point in one plane: nothing measures the rotation about its normal");
}

}  // namespace

bool Place::anywhere() const
{
    return std::isinf(tilt_limit_rad);
}

Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 3, 3> instrument_axes(unsigned axes_each)
{
    if (axes_each == 1) return Vector3d::UnitZ().transpose();
    return Matrix3d::Identity().topRows(axes_each);
}

Matrix3d attitude(const Place& place, const Eigen::Vector2d& tilt_rad, double azimuth_rad, double lean_rad, double turn_rad)
{
    const double tilt = tilt_rad.norm();
    Matrix3d tilted = place.base;
    if (tilt > 0) tilted *= Eigen::AngleAxisd(tilt, Vector3d(tilt_rad.x(), tilt_rad.y(), 0) / tilt).toRotationMatrix();
    return tilted * about_z(azimuth_rad) * about_y(lean_rad) * about_z(turn_rad) * place.inner;
}

Choices choices(const Brief& brief)
{
    Choices found = std::visit([&](const auto& mounting) { return choices_of(mounting, brief); }, brief.mounting);
    drop_repetitions(found.places, brief.axes_each);
    return found;
}

tl::expected<void, std::string> check_mounting(const Brief& brief)
{
    if (const auto kind = std::visit([&](const auto& mounting) { return check_kind(mounting, brief); }, brief.mounting); !kind) return kind;
    return check_directions(brief);
}

}  // namespace quorient::design
