#pragma once

#include "quorient/messages/identity.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace quorient::attitude {

/// Whether an integrator has an attitude, and how it came by it. The diagram is in common/attitude/README.md; a test compares both.
enum class StartState : std::uint8_t {
    /// No attitude is known. Frames are only collected, and the mode is INITIALISING. It ends when a voted attitude connects to the frames
    /// (taking_over), when a command states the attitude at one of them (aligning), or with an epoch whose start is stated (aligned).
    waiting,

    /// A voted attitude was taken over at a past frame, and what follows is still to be integrated. The mode is INITIALISING. It ends
    /// when the newest frame is integrated (seeded), by a command (aligning), or when the first frame after the seed does not follow it
    /// directly, so that the rotation in between cannot be known (waiting).
    taking_over,

    /// A command stated the attitude at a past frame while none was known, and what follows is still to be integrated. The mode is
    /// INITIALISING. It ends when the newest frame is integrated (aligned), or when a voted attitude is taken over (taking_over).
    aligning,

    /// The attitude goes back to one that was stated by the configuration, a description or a command. It ends when a voted attitude is
    /// taken over: after an absence of this process the other lanes know better (taking_over).
    aligned,

    /// The attitude goes back to the voted one, and is marked as SEEDED. It ends when another voted attitude is taken over, because the
    /// first one had a fault in it or this process was absent (taking_over), or by a command (aligned).
    seeded,
};

inline constexpr std::array all_start_states{StartState::waiting, StartState::taking_over, StartState::aligning, StartState::aligned,
                                             StartState::seeded};

const char* to_string(StartState state);

/// The start of an integrator, and every later start: what it waits for, where its attitude comes from, and what else it could take over.
class Start {
public:
    explicit Start(bool aligned) : state_(aligned ? StartState::aligned : StartState::waiting) {}

    StartState state() const { return state_; }

    /// No attitude is to be published yet.
    bool is_initialising() const { return state_ == StartState::waiting || is_catching_up(); }

    /// An attitude is known at a past frame, and not yet at the newest one.
    bool is_catching_up() const { return state_ == StartState::taking_over || state_ == StartState::aligning; }

    /// The attitude goes back to a voted one.
    bool is_seeded() const { return state_ == StartState::taking_over || state_ == StartState::seeded; }

    // What happens to it.

    /// Everything up to the newest frame is integrated.
    void on_caught_up();

    /// The rotation since the seed cannot be known.
    void on_lost_track();

    /// A command has stated the attitude at a frame of the history. It also ends a wait for a seed.
    void on_reset();

    /// An epoch has begun at a stated attitude.
    void on_stated_epoch();

    /// The seed that waited has connected to its frame.
    void on_seed_connected();

    /// A frame came after others that this process never received.
    void on_absence(Identity first_after) { absent_until_ = first_after; }

    // What it could start from.

    /// A seed whose frame has not come yet, or which no frame follows yet; nothing if there is none.
    const VotedAttitude* waiting_seed() const { return waiting_seed_ ? &*waiting_seed_ : nullptr; }
    void wait_for(const VotedAttitude& seed) { waiting_seed_ = seed; }
    void drop_seed() { waiting_seed_.reset(); }

    /// The attitude at the start of this epoch, if its description has stated one.
    const rotation::Quaternion* stated_for(std::uint64_t epoch) const;
    void state_epoch(std::uint64_t epoch, const rotation::Quaternion& attitude) { stated_ = StatedStart{epoch, attitude}; }

    // What was taken over, and what came since.

    /// The frame of the newest seed.
    Identity seed_frame() const { return seed_frame_; }

    /// The newest seed was UNTRUSTED itself.
    bool seed_was_untrusted() const { return seed_was_untrusted_; }

    /// @returns false for a voted attitude that is older than another one that came.
    bool is_newest(const VotedAttitude& voted);

    /// The first voted attitude after an absence decides whether the other lanes know better. @returns whether this is the one; only once.
    bool ends_absence(const VotedAttitude& voted);

private:
    struct StatedStart {
        std::uint64_t epoch = 0;
        rotation::Quaternion attitude;
    };

    StartState state_;
    std::optional<VotedAttitude> waiting_seed_;  // set by wait_for(); gone once it has connected, or can never connect
    std::optional<StatedStart> stated_;          // the newest stated epoch, whether or not it has begun
    Identity seed_frame_;                        // the frame of the seed that connected last; no meaning unless is_seeded()
    bool seed_was_untrusted_ = false;            // likewise
    Identity newest_voted_;                      // the newest of all voted attitudes that came
    std::optional<Identity> absent_until_;       // first frame after this process missed some; until a voted attitude came since
};

}  // namespace quorient::attitude
