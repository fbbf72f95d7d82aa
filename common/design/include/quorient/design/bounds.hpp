#pragma once

#include "quorient/design/brief.hpp"

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::design {

/// The worst case after so many failures cannot be better than this.
struct BoundAfter {
    unsigned failures = 0;
    double trace = 0;
    double volume = 0;
};

/// What no array of so many axes can pass, however they are mounted. Figures as in Figures.
///
/// trace and volume: of all H with the same sum of squares, H'H = sum/3 I is best [paper 002; arithmetic and geometric mean].
/// After k failures of single axes: weigh the sets of m = n - k axes that are left by det(A_K), A_K = sum of h h'. By Cauchy-Binet
///   sum det(A_K) = C(n-3, m-3) det A,  sum det(A_K) tr(A_K^-1) = sum e_2(A_K) = C(n-2, m-2) e_2(A),
/// so the largest trace is at least (n-2)/(m-2) tr(A^-1), and the smallest determinant at most C(n-3, m-3)/C(n, m) det A.
/// After k whole instruments: the mean of the A_K is a share of A.
/// F_d1 <= (n-3)/n [paper 004, eq 24]. F_d2 <= (n-1)(n-3)/3: sum_j W_ij^2 = W_ii, so the largest of the n-1 others is at least
/// W_ii (1 - W_ii)/(n-1), and some W_ii is at most (n-3)/n.
struct Bounds {
    double trace = 0;
    double volume = 0;
    double condition = 1;
    double minimum_angle_rad = 0;
    std::vector<BoundAfter> worst_after;
    double f_d1 = 0;
    double f_d2 = 0;
    unsigned detectable = 0;
    unsigned isolable = 0;
};

Bounds bounds(const Brief& brief);

/// The largest smallest angle between `count` lines in space that is not ruled out [rad]; from 2 lines.
/// Exact up to 7 lines (Fejes Toth 1965; 7: Rankin's bound acos(1/sqrt 3), which is met); above, the smaller one of that and of
/// Fejes Toth's bound for twice as many points on a sphere.
double largest_minimum_angle_rad(std::size_t count);

/// Why a brief cannot be met, and which of its demands is to blame: the name of the key in a brief's file, and of the option.
struct Refusal {
    std::string demand;
    std::string reason;  ///< the bound that forbids it, or the contradiction
};

/// Whether these demands can be met at all, as far as a bound can tell.
tl::expected<Bounds, Refusal> check(const Brief& brief);

}  // namespace quorient::design
