#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/geometry/triads.hpp"
#include "quorient/messages/stream_place.hpp"

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// Four axes: the parity scalar v'z shows that there is a fault and not where, so time has to: a derived method predicts the
/// motion from the frames before the fault and the triad that fits the prediction leaves out the faulty axis. [paper 003]
///
/// This base holds what such methods share. A frame is suspicious when |v'z| exceeds
///   bound = 2 sum |v_i| quantum_i + z(1 - pfa/2) sqrt(sum v_i^2 sigma_i^2)     (v of unit norm; or settings.tolerance),
/// twice what carried quantisation can do, plus the noise's quantile. From the first suspicious frame on the history is *held*: it
/// takes in nothing more until the parity was below half the bound for `release_frames` frames, then it is learnt anew, these first.
///
/// A gap of up to `longest_gap` frames is bridged where the method predicts over many frames: the history is held as if the missing frames
/// had been suspicious, so that a fault which begins with the gap finds a history without it; several, where all lie within as many frames
/// behind that history. Any other frame that does not follow its predecessor (a longer gap, another interval) starts the history again.
///
/// The first `warm_up_frames` frames are warming_up. A fault that is there before any history leaves all four axes as candidates.
/// A frame with one axis missing cannot contradict itself: it is healthy with statistic 0. With an axis excluded every frame is,
/// and detectable_remaining() is 0. An excluded axis that is trusted again while it is still wrong cannot be named, for want of a history
/// without its fault; so expectation() shows whether the other three agree with it. Allocates nothing per frame.
class FourAxisDetector : public Detector {
public:
    static constexpr std::size_t axis_count = 4;
    static constexpr unsigned warm_up_frames = 4;
    static constexpr unsigned release_frames = 8;
    static constexpr unsigned longest_gap = 64;

    void assess(const Measurement& measurement, Assessment& assessment) final;
    void exclude(AxisMask excluded) final;
    unsigned detectable_remaining() const final { return excluded_ == 0 ? 1 : 0; }
    /// What the other three axes make of an excluded one. It agrees where |v'z| was within the bound for `release_frames` frames, and
    /// where nothing is known against it.
    std::optional<Expectation> expectation(std::size_t axis) const final;
    void reset() final;

    const Eigen::Vector4d& parity_vector() const { return parity_vector_; }           ///< v, unit norm
    double bound() const { return bound_; }                                           ///< for |v'z| [unit of z]
    const geometry::Triad& triad(std::size_t index) const { return triads_[index]; }  ///< T1..T4, lexicographic

protected:
    /// The least that every four-axis method needs to know of its cluster.
    struct Geometry {
        std::array<geometry::Triad, axis_count> triads;
        Eigen::Vector4d parity_vector;
        Eigen::Matrix<double, 3, 4> least_squares;
        double bound = 0;
        double parity_sigma = 0;    ///< v'z has it by noise alone
        double parity_quantum = 0;  ///< sum |v_i| quantum_i
        Eigen::Vector4d variance;   ///< one increment's, noise and quantisation
    };

    /// One frame, seen through all triads.
    struct Frame {
        Identity identity;
        Eigen::Vector3d body = Eigen::Vector3d::Zero();  ///< least squares [unit of z]
        std::array<Eigen::Vector3d, axis_count> triad_body{};
        double parity = 0;     ///< v'z
        unsigned horizon = 1;  ///< frames since the newest one in the history
    };

    /// @returns why these axes or figures cannot serve: not four axes, three in one plane, noise unknown.
    static tl::expected<Geometry, std::string> geometry_of(const DetectorSettings& settings, const geometry::SensorCluster& cluster,
                                                           std::string_view method);

    explicit FourAxisDetector(const Geometry& made);

    /// Every complete frame, before it is judged.
    virtual void observe(const Frame& frame) = 0;
    /// A frame without suspicion joins the history.
    virtual void learn(const Frame& frame) = 0;
    /// A suspicious frame: says isolated or ambiguous.
    virtual void attribute(const Frame& frame, Assessment& assessment) = 0;
    /// The history is of no more use.
    virtual void forget() = 0;
    /// Frames in the history.
    virtual unsigned learnt() const = 0;
    /// Whether the history predicts frames that do not follow it at once (Frame::horizon).
    virtual bool predicts_over_gaps() const = 0;

    /// The fault is on the axis that this triad leaves out.
    static AxisMask left_out_by(std::size_t triad) { return axis_bit(axis_count - 1 - triad); }

    /// The size of a frame's smallest meaningful difference: one quantum where there is no noise [unit of z].
    double resolution() const;

private:
    bool same_spacing(const Measurement& measurement) const;
    bool follows(const Measurement& measurement) const;
    bool bridge_gap_before(const Measurement& measurement);
    Frame frame_of(const Measurement& measurement) const;
    void judge(const Frame& frame, Assessment& assessment);
    void judge_suspicion(const Frame& frame, Assessment& assessment);
    void start_again();
    void release();
    void compare_excluded(const Measurement& measurement);

    std::array<geometry::Triad, axis_count> triads_;
    Eigen::Vector4d parity_vector_;
    Eigen::Matrix<double, 3, 4> least_squares_;
    double bound_;
    AxisMask excluded_ = 0;
    bool started_ = false;
    StreamPlace place_;  ///< behind the newest frame that was used
    double interval_s_ = 0;
    unsigned frames_ = 0;  ///< complete ones since the start, up to warm_up_frames
    bool holding_ = false;
    unsigned held_frames_ = 0;   ///< frames that passed since the history was held
    unsigned quiet_frames_ = 0;  ///< the latest of them, one after another, without suspicion
    std::array<Frame, release_frames> quiet_;
    unsigned disputed_ = 0;  ///< frames to come until an excluded axis that agrees in all of them counts as one that agrees
    double expected_ = 0;    ///< the excluded axis's value, by the other three [unit of z]
};

}  // namespace quorient::fdi
