#pragma once

#include "quorient/design/brief.hpp"

#include <Eigen/Core>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::design {

/// Where one instrument may stand. Its attitude is base E(tilt) Rz(azimuth) Ry(lean) Rz(turn) inner, E(tilt) the rotation by the vector
/// (tilt_x, tilt_y, 0); what is free is chosen by the search.
struct Place {
    Eigen::Matrix3d base = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d inner = Eigen::Matrix3d::Identity();
    double azimuth_rad = 0;
    double lean_rad = 0;
    double turn_rad = 0;
    double tilt_limit_rad = 0;  ///< 0: not tilted; infinite: anywhere, from a random base
    bool azimuth_free = false;
    bool lean_shared = false;  ///< one lean, chosen by the search, for all places that share it
    bool turn_free = false;
    std::size_t holds = max_axes;  ///< instruments at most …
    std::size_t face = 0;          ///< … on all places of this face together

    bool fixed() const { return tilt_limit_rad == 0 && !azimuth_free && !lean_shared && !turn_free; }
    bool anywhere() const;
};

/// An instrument of the array: the place that decides its attitude, and the turn of the whole array that takes it there from it.
struct Stand {
    Place place;
    std::vector<Eigen::Matrix3d> images{Eigen::Matrix3d::Identity()};  ///< one instrument each
};

/// What a mounting leaves to choose: one of these lists of stands (a single one, or one for each way to complete a symmetry), or for
/// each instrument one of these places.
struct Choices {
    std::vector<std::vector<Stand>> stands;
    std::vector<Place> places;  ///< without those that give the same lines as an earlier one
};

/// For a brief that passed check_mounting.
Choices choices(const Brief& brief);

/// The axes (rows) of an instrument of `axes_each` axes: z; x and y; x, y and z.
Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 3, 3> instrument_axes(unsigned axes_each);

/// The attitude at a place with these free values.
Eigen::Matrix3d attitude(const Place& place, const Eigen::Vector2d& tilt_rad, double azimuth_rad, double lean_rad, double turn_rad);

/// @returns the contradiction in the mounting, or between it and the instruments.
tl::expected<void, std::string> check_mounting(const Brief& brief);

}  // namespace quorient::design
