#include "start.hpp"

#include "quorient/messages/meaning.hpp"

#include <cassert>

namespace quorient::attitude {

const char* to_string(StartState state)
{
    switch (state) {
        case StartState::waiting:
            return "waiting";
        case StartState::taking_over:
            return "taking_over";
        case StartState::aligning:
            return "aligning";
        case StartState::aligned:
            return "aligned";
        case StartState::seeded:
            return "seeded";
    }
    return "unknown";
}

void Start::on_caught_up()
{
    if (state_ == StartState::taking_over) state_ = StartState::seeded;
    if (state_ == StartState::aligning) state_ = StartState::aligned;
}

void Start::on_lost_track()
{
    assert(state_ == StartState::taking_over);
    state_ = StartState::waiting;
}

void Start::on_reset()
{
    state_ = is_initialising() ? StartState::aligning : StartState::aligned;
    drop_seed();
}

void Start::on_stated_epoch()
{
    if (state_ == StartState::waiting) state_ = StartState::aligned;
}

void Start::on_seed_connected()
{
    assert(waiting_seed_);
    state_ = StartState::taking_over;
    seed_frame_ = identity_of(*waiting_seed_);
    seed_was_untrusted_ = mode_of(*waiting_seed_) == AttitudeMode::untrusted;
    drop_seed();
}

const rotation::Quaternion* Start::stated_for(std::uint64_t epoch) const
{
    return stated_ && stated_->epoch == epoch ? &stated_->attitude : nullptr;
}

bool Start::is_newest(const VotedAttitude& voted)
{
    if (identity_of(voted) < newest_voted_) return false;
    newest_voted_ = identity_of(voted);
    return true;
}

bool Start::ends_absence(const VotedAttitude& voted)
{
    if (!absent_until_ || identity_of(voted) < *absent_until_) return false;
    absent_until_.reset();
    return true;
}

}  // namespace quorient::attitude
