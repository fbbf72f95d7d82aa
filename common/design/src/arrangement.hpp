#pragma once

#include "places.hpp"

#include <Eigen/Core>
#include <random>
#include <vector>

namespace quorient::design {

/// An array as a function of what is free in its mounting: variables x (tilts, azimuths, turns, one shared lean) to axes.
class Arrangement {
public:
    /// @param kept  axes in front that do not move.
    Arrangement(geometry::Axes kept, unsigned axes_each, std::vector<Stand> stands);

    Eigen::Index variables() const { return variables_; }
    Eigen::Index axis_count() const { return axis_count_; }

    /// Draws bases of what may point anywhere, and a starting point within the limits.
    Eigen::VectorXd draw(std::mt19937_64& random);

    /// The middle of what is allowed.
    Eigen::VectorXd nominal() const;

    geometry::Axes axes(const Eigen::VectorXd& x) const;

    /// d axes / d x: 3 n rows (all x, all y, all z), a column per variable.
    Eigen::MatrixXd derivative(const Eigen::VectorXd& x) const;

    /// tilt^2 - limit^2 of each place that may be tilted within a limit: not above 0.
    Eigen::VectorXd tilt_excess(const Eigen::VectorXd& x) const;
    Eigen::MatrixXd tilt_excess_derivative(const Eigen::VectorXd& x) const;

private:
    /// Where the variables of a stand are in x; -1: it has none.
    struct Slots {
        Eigen::Index tilt = -1;
        Eigen::Index azimuth = -1;
        Eigen::Index turn = -1;
    };
    struct Values {
        Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
        double azimuth, lean, turn;
    };

    Values values(std::size_t stand, const Eigen::VectorXd& x) const;
    void add_derivative(std::size_t stand, Eigen::Index first_axis, const Eigen::VectorXd& x, Eigen::MatrixXd& all) const;
    bool limited(std::size_t stand) const;

    geometry::Axes kept_;
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 3, 3> own_;
    std::vector<Stand> stands_;
    std::vector<Slots> slots_;
    Eigen::Index lean_ = -1;
    Eigen::Index variables_ = 0;
    Eigen::Index axis_count_ = 0;
};

}  // namespace quorient::design
