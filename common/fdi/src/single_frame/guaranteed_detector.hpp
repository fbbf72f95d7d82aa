#pragma once

#include "single_frame/frame_detector.hpp"
#include "quorient/fdi/settings.hpp"

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// Guaranteed (set-membership) estimation with at most k = 1 or 2 simultaneous faults. [paper 000]
///
/// Regular errors are bounded, |z_i - h_i q| <= sigma_i, faults are not. For every set w of k axes,
///   Q_w = { q : |z_i - h_i q| <= sigma_i for i not in w };   J_w, I_w = min, max of a'q over Q_w;
///   lmin = min J_w, lmax = max I_w over the feasible w;   s0 = (lmin + lmax)/2, delta = (lmax - lmin)/2;   rho_i = z_i - s0_i (a = h_i).
/// Axis i is F (faulty) iff |rho_i| - delta_i > A, H (healthy) iff |rho_i| + delta_i <= A, else U (undecided).
///
/// Exact, in place of the paper's linear programs. By duality I_w = min over x with H'x = a, x_w = 0 of z'x + sigma'|x|, a convex
/// piecewise linear function that has its minimum where x solves three independent rows: at a *basis*, all of which are known in
/// advance. Q_w is empty iff |v'z| > sigma'|v| for some *circuit* v (v'H = 0 with smallest support) outside w: every v'H = 0 is a
/// sum of circuits that agree in sign, so no other need be tried. Where the axes left span no space, bases have as many rows as their
/// rank, and a direction that they do not reach has the interval R.
///
/// Guaranteed if the noise stays within the bound and at most k axes are faulty: the true rho_i is in its interval, so with
/// A >= sigma no F is ever wrong. Not guaranteed: a verdict. Several feasible sets stay an ambiguity, and their hull may be wide.
/// Empty Q for all w: more than k faults, or noise beyond the bound (`blind`).
///
/// For k + 4 to 8 axes. After exclusions with m axes left it assumes at most m - 4 faults.
class GuaranteedDetector final : public FrameDetector {
public:
    struct Interval {
        double lower = 0;
        double upper = 0;
    };

    /// Settings: bound (else from noise), threshold A (else the smallest with which bounded noise alone is never undecided),
    /// max_faults (default 2 where there are six axes, else 1).
    static tl::expected<std::unique_ptr<GuaranteedDetector>, std::string> make(const DetectorSettings& settings,
                                                                       const geometry::SensorCluster& cluster);

    /// What the last frame gave; unit of z throughout.
    bool empty() const { return feasible_.none(); }
    std::size_t feasible_count() const { return feasible_.count(); }
    std::size_t set_count() const { return set_count_; }  ///< all sets w, in lexicographic order
    AxisMask set(std::size_t index) const { return sets_[index].without; }
    bool feasible(std::size_t index) const { return feasible_.test(index); }
    Interval interval(std::size_t axis) const;                         ///< [lmin, lmax] of h_i q
    char decision(std::size_t axis) const { return decision_[axis]; }  ///< F, H or U

    /// [J_w, I_w] of one set along any direction (body frame); the empty interval [inf, -inf] where Q_w is empty. Allocates nothing.
    Interval interval_of(std::size_t index, const Eigen::Vector3d& direction) const;

    /// [lmin, lmax] along any direction.
    Interval interval_along(const Eigen::Vector3d& direction) const;

    double threshold() const { return threshold_; }

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    static constexpr int max_size = 8;
    static constexpr std::size_t max_sets = 28;       // 8 over 2
    static constexpr std::size_t max_bases = 92;      // 8 over 3, 2, 1
    static constexpr std::size_t max_circuits = 154;  // 8 over 4, 3, 2
    using PerAxis = Eigen::Array<double, max_size, 1>;
    using SetFlags = std::bitset<max_sets>;

    /// Independent rows T, and x with x_T = H_T^-T h_i for every axis i at once (its place in the columns of `solution`).
    struct Basis {
        AxisMask rows = 0;
        std::array<std::uint8_t, 3> row{};
        std::uint8_t rank = 0;
        std::array<PerAxis, 3> solution;  ///< x_T, one array per row of T, over i
        PerAxis spread;                   ///< sum of sigma_j |x_j|; inf where T does not reach h_i
    };

    struct Circuit {
        std::array<std::uint8_t, 4> row{};
        Eigen::Vector4d weight = Eigen::Vector4d::Zero();  ///< v / (sigma'|v|)
        SetFlags outside;                                  ///< the sets w that the circuit avoids
    };

    struct FaultSet {
        AxisMask without = 0;
        std::uint8_t rank = 0;  ///< the rank of the rows that are left
        std::uint8_t basis_count = 0;
        std::array<std::uint8_t, 56> basis{};
    };

    GuaranteedDetector(const geometry::SensorCluster& cluster, const geometry::AxisVector& bound, unsigned max_faults);

    void form(AxisMask working) override;
    void judge(const geometry::AxisVector& z, Assessment& assessment) override;

    void form_sets(AxisMask working);
    void form_bases(AxisMask working);
    void form_circuits(AxisMask working);
    void add_basis(AxisMask rows);
    void add_circuit(AxisMask rows);
    double least_decisive_threshold() const;

    double test_feasibility(const geometry::AxisVector& z);
    void bound_axes(const geometry::AxisVector& z);
    void decide(const geometry::AxisVector& z, Assessment& assessment);
    void add_axes(const Assessment& assessment, std::vector<Detail>& details) const;

    geometry::AxisVector bound_;
    unsigned max_faults_;
    std::optional<double> configured_threshold_;
    std::optional<Eigen::Vector3d> direction_;  ///< for the additional interval in details()
    double threshold_ = 0;
    double largest_bound_ = 0;

    std::array<FaultSet, max_sets> sets_;
    std::array<Basis, max_bases> bases_;
    std::array<Circuit, max_circuits> circuits_;
    std::size_t set_count_ = 0;
    std::size_t basis_count_ = 0;
    std::size_t circuit_count_ = 0;

    geometry::AxisVector z_;
    SetFlags feasible_;
    PerAxis lower_;
    PerAxis upper_;
    std::array<char, max_size> decision_{};
};

}  // namespace quorient::fdi
