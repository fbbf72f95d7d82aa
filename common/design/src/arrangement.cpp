#include "arrangement.hpp"

#include "numbers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d random_rotation(std::mt19937_64& random)
{
    boost::random::normal_distribution<double> normal;
    Eigen::Vector4d q;
    for (double& part : q) part = normal(random);
    q.normalize();
    return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).toRotationMatrix();
}

/// The rotation about its own axis that a small change of the rotation vector v adds behind exp(v): exp(v + d) = exp(v) exp(J d).
Matrix3d right_jacobian(const Vector3d& v)
{
    const double angle = v.norm();
    Matrix3d cross;
    cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    if (angle < 1e-6) return Matrix3d::Identity() - cross / 2 + cross * cross / 6;
    const double square = angle * angle;
    return Matrix3d::Identity() - (1 - std::cos(angle)) / square * cross + (angle - std::sin(angle)) / (square * angle) * cross * cross;
}

}  // namespace

Arrangement::Arrangement(geometry::Axes kept, unsigned axes_each, std::vector<Stand> stands)
    : kept_(std::move(kept)), own_(instrument_axes(axes_each)), stands_(std::move(stands)), axis_count_(kept_.rows())
{
    for (const Stand& stand : stands_) {
        Slots slots;
        const auto take = [&](bool wanted, Index& slot, Index count) {
            if (!wanted) return;
            slot = variables_;
            variables_ += count;
        };
        take(stand.place.tilt_limit_rad > 0, slots.tilt, 2);
        take(stand.place.azimuth_free, slots.azimuth, 1);
        take(stand.place.turn_free, slots.turn, 1);
        if (stand.place.lean_shared && lean_ < 0) take(true, lean_, 1);
        slots_.push_back(slots);
        axis_count_ += static_cast<Index>(stand.images.size()) * own_.rows();
    }
}

bool Arrangement::limited(std::size_t stand) const
{
    return slots_[stand].tilt >= 0 && !stands_[stand].place.anywhere();
}

Eigen::VectorXd Arrangement::nominal() const
{
    Eigen::VectorXd x = Eigen::VectorXd::Zero(variables_);
    for (std::size_t k = 0; k < stands_.size(); ++k) {
        if (slots_[k].azimuth >= 0) x(slots_[k].azimuth) = stands_[k].place.azimuth_rad;
        if (slots_[k].turn >= 0) x(slots_[k].turn) = stands_[k].place.turn_rad;
        if (lean_ >= 0 && stands_[k].place.lean_shared) x(lean_) = stands_[k].place.lean_rad;
    }
    return x;
}

Eigen::VectorXd Arrangement::draw(std::mt19937_64& random)
{
    boost::random::uniform_real_distribution<double> share(0, 1);
    Eigen::VectorXd x = nominal();
    for (std::size_t k = 0; k < stands_.size(); ++k) {
        Place& place = stands_[k].place;
        if (place.anywhere()) place.base = random_rotation(random);
        if (limited(k)) {
            const double direction = 2 * pi * share(random);
            const double tilt = place.tilt_limit_rad * std::sqrt(share(random));
            x.segment<2>(slots_[k].tilt) << tilt * std::cos(direction), tilt * std::sin(direction);
        }
        if (slots_[k].azimuth >= 0) x(slots_[k].azimuth) = 2 * pi * share(random);
        if (slots_[k].turn >= 0) x(slots_[k].turn) = 2 * pi * share(random);
    }
    if (lean_ >= 0) x(lean_) = pi / 6 + pi / 4 * share(random);
    return x;
}

Arrangement::Values Arrangement::values(std::size_t stand, const Eigen::VectorXd& x) const
{
    const Place& place = stands_[stand].place;
    const Slots& slots = slots_[stand];
    Values found{Eigen::Vector2d::Zero(), place.azimuth_rad, place.lean_rad, place.turn_rad};
    if (slots.tilt >= 0) found.tilt = x.segment<2>(slots.tilt);
    if (slots.azimuth >= 0) found.azimuth = x(slots.azimuth);
    if (place.lean_shared) found.lean = x(lean_);
    if (slots.turn >= 0) found.turn = x(slots.turn);
    return found;
}

geometry::Axes Arrangement::axes(const Eigen::VectorXd& x) const
{
    geometry::Axes all(axis_count_, 3);
    all.topRows(kept_.rows()) = kept_;
    Index next = kept_.rows();
    for (std::size_t k = 0; k < stands_.size(); ++k) {
        const Values v = values(k, x);
        const Matrix3d turned = attitude(stands_[k].place, v.tilt, v.azimuth, v.lean, v.turn);
        for (const Matrix3d& image : stands_[k].images) {
            all.middleRows(next, own_.rows()) = own_ * (image * turned).transpose();
            next += own_.rows();
        }
    }
    return all;
}

/// Each variable turns what stands behind it in the product of rotations: d(R exp(s a) u)/ds = R (a x u).
void Arrangement::add_derivative(std::size_t stand, Index first_axis, const Eigen::VectorXd& x, Eigen::MatrixXd& all) const
{
    const Place& place = stands_[stand].place;
    const Slots& slots = slots_[stand];
    const Values v = values(stand, x);
    const auto about_z = [](double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix(); };
    const Matrix3d tilted = attitude(Place{.base = place.base}, v.tilt, 0, 0, 0);
    const Matrix3d turned_to = tilted * about_z(v.azimuth);
    const Matrix3d leant = turned_to * Eigen::AngleAxisd(v.lean, Vector3d::UnitY()).toRotationMatrix();
    const Matrix3d jacobian = right_jacobian(Vector3d(v.tilt.x(), v.tilt.y(), 0));
    const Index n = axis_count_;
    for (const Matrix3d& image : stands_[stand].images) {
        for (Index own = 0; own < own_.rows(); ++own, ++first_axis) {
            const Vector3d on_lean = about_z(v.turn) * place.inner * own_.row(own).transpose();
            const auto put = [&](Index column, const Vector3d& change) {
                const Vector3d seen = image * change;
                for (Index part = 0; part < 3; ++part) all(part * n + first_axis, column) += seen(part);
            };
            const Vector3d in_azimuth = Eigen::AngleAxisd(v.lean, Vector3d::UnitY()) * on_lean;
            const Vector3d in_tilt = about_z(v.azimuth) * in_azimuth;
            if (slots.tilt >= 0)
                for (Index part = 0; part < 2; ++part) put(slots.tilt + part, tilted * jacobian.col(part).cross(in_tilt));
            if (slots.azimuth >= 0) put(slots.azimuth, turned_to * Vector3d::UnitZ().cross(in_azimuth));
            if (place.lean_shared) put(lean_, turned_to * Vector3d::UnitY().cross(in_azimuth));
            if (slots.turn >= 0) put(slots.turn, leant * Vector3d::UnitZ().cross(on_lean));
        }
    }
}

Eigen::MatrixXd Arrangement::derivative(const Eigen::VectorXd& x) const
{
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * axis_count_, variables_);
    Index first_axis = kept_.rows();
    for (std::size_t k = 0; k < stands_.size(); ++k) {
        add_derivative(k, first_axis, x, all);
        first_axis += static_cast<Index>(stands_[k].images.size()) * own_.rows();
    }
    return all;
}

Eigen::VectorXd Arrangement::tilt_excess(const Eigen::VectorXd& x) const
{
    std::vector<double> excess;
    for (std::size_t k = 0; k < stands_.size(); ++k)
        if (limited(k)) excess.push_back(x.segment<2>(slots_[k].tilt).squaredNorm() - std::pow(stands_[k].place.tilt_limit_rad, 2));
    return Eigen::Map<const Eigen::VectorXd>(excess.data(), static_cast<Index>(excess.size()));
}

Eigen::MatrixXd Arrangement::tilt_excess_derivative(const Eigen::VectorXd& x) const
{
    const auto rows = tilt_excess(x).size();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows, variables_);
    Index row = 0;
    for (std::size_t k = 0; k < stands_.size(); ++k)
        if (limited(k)) all.block<1, 2>(row++, slots_[k].tilt) = 2 * x.segment<2>(slots_[k].tilt).transpose();
    return all;
}

}  // namespace quorient::design
