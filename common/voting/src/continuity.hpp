#pragma once

#include "agreement.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <cstdint>

namespace quorient::voting {

/// What follows on what: whether an output continues the stream that consumers have seen, and if not, by which rotation it moved.
///
/// Attitudes of two lanes differ by a rotation of the reference frame that stays constant while both integrate the same motion
/// (increments multiply from the right): q_new = R o q_old. So R is found at the last published frame, where both are known.
class Continuity {
public:
    struct Reset {
        std::uint32_t counter = 0;
        Quaternion rotation = no_rotation;
        bool moved = false;
    };

    /// The stream went on with this output, our own or that of the voter we follow.
    void follow(const VotedAttitude& output);

    /// Apart by no more than rounding, which no consumer could notice.
    static bool is_same(const Quaternion& a, const Quaternion& b);

    bool started() const { return started_; }
    Identity identity() const { return identity_; }
    std::uint32_t lane() const { return lane_; }

    /// What to announce when `sample` follows.
    /// @param before  the same lane's sample of the frame followed last; null where it is not known.
    Reset next(const AttitudeState& sample, const AttitudeState* before) const;

private:
    Quaternion rotation_to(const AttitudeState& sample, const AttitudeState* before) const;

    bool started_ = false;
    Identity identity_;
    std::int64_t sample_time_ns_ = 0;
    std::uint32_t lane_ = 0;
    std::uint32_t counter_ = 0;
    Quaternion attitude_ = no_rotation;
    Quaternion rotation_ = no_rotation;
    std::array<double, 3> rate_rad_s_{};
};

}  // namespace quorient::voting
