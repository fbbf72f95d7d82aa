#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/stream_place.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace quorient::intake {

/// The door of every consumer of frames: lets through what is new, of the right publisher, described and finite; counts the rest.
///
/// - Duplicates and older identities are dropped.
/// - A newer epoch is accepted only after the current one was silent for max(5 intervals, 100 ms); until then its publisher is foreign.
/// - A frame of a description that is not here yet waits (64 frames at most, the oldest give way).
/// - A frame with a wrong axis count, interval or time is refused; an axis with a value that is not finite or beyond its stated range
///   loses its valid bit.
class FrameIntake {
public:
    struct Counters {
        std::uint64_t accepted = 0;
        std::uint64_t gaps = 0;  ///< frames that never arrived
        std::uint64_t duplicates = 0;
        std::uint64_t late = 0;
        std::uint64_t foreign = 0;
        std::uint64_t rejected_frames = 0;
        std::uint64_t rejected_values = 0;
        std::uint64_t waiting_lost = 0;  ///< gave way while their description did not come
    };

    /// What a publisher does wrong.
    enum class Fault {
        none,
        description,       ///< problem_of() says what
        axis_count,        ///< got, expected: of the frame, of its description
        interval,          ///< not above 0
        sample_time,       ///< does not increase
        unknown_revision,  ///< got, expected: the frames', the newest described of that epoch
        no_description,    ///< none of that epoch came
        sequence_restart,  ///< got, expected: the frame's, the newest handled; a restart needs a new epoch
        value,             ///< got: the axis; not finite, or beyond its stated range
    };
    struct Complaint {
        Fault fault = Fault::none;
        Identity identity;
        std::uint64_t got = 0;
        std::uint64_t expected = 0;
        const char* why = "";  ///< for a description
    };

    struct Accepted {
        SensorFrame frame;
        std::uint64_t missing_before = 0;  ///< lost or refused since the frame accepted before; in a new epoch, since its sequence 0
        bool new_epoch = false;            ///< the first frame of its epoch
        bool new_description = false;      ///< description() changed with this frame
    };

    FrameIntake(std::uint32_t unit, SensorKind kind) : unit_(unit), kind_(kind) {}

    void describe(const ClusterDescription& description);

    /// @param now_ns  steady clock. @returns false if the frame is another unit's or kind's.
    bool offer(const SensorFrame& frame, std::int64_t now_ns);

    /// The next frame to handle, in order; nothing when all are handled. Valid until the next call.
    const Accepted* next();

    /// The description of the frames now being handled; nothing before the first.
    const ClusterDescription* description() const { return current_ ? &*current_ : nullptr; }

    /// A description is here, whether or not frames are.
    bool described() const { return description_count_ > 0; }

    const Counters& counters() const { return counters_; }
    Identity newest() const { return newest_; }

    /// Epoch of the foreign publisher seen last; 0 = none yet.
    std::uint64_t foreign_epoch() const { return foreign_epoch_; }

    /// What was wrong last; counted by complaints().
    const Complaint& complaint() const { return complaint_; }
    std::uint64_t complaints() const { return complaints_; }

    /// What is wrong with a description, or nothing.
    static const char* problem_of(const ClusterDescription& description);

private:
    static constexpr std::size_t waiting_capacity = 64;
    static constexpr std::size_t remembered_descriptions = 4;

    void complain(const Complaint& complaint);
    void look_at_waiting(std::int64_t now_ns);
    bool order(const SensorFrame& frame, std::int64_t now_ns);
    const ClusterDescription* description_for(const SensorFrame& frame) const;
    bool clean(SensorFrame& frame, const ClusterDescription& description);

    std::uint32_t unit_;
    SensorKind kind_;
    std::array<ClusterDescription, remembered_descriptions> descriptions_{};
    std::size_t description_count_ = 0;
    std::size_t description_next_ = 0;
    std::optional<ClusterDescription> current_;
    std::array<SensorFrame, waiting_capacity> waiting_{};
    std::size_t waiting_begin_ = 0;
    std::size_t waiting_count_ = 0;
    Accepted accepted_;
    Counters counters_;
    Identity newest_;
    bool started_ = false;
    std::int64_t last_arrival_ns_ = 0;
    std::int64_t last_sample_time_ns_ = 0;
    StreamPlace handled_;  ///< behind the frame accepted last
    std::uint64_t foreign_epoch_ = 0;
    double interval_s_ = 0;
    Complaint complaint_;
    std::uint64_t complaints_ = 0;
    std::int64_t waiting_since_ns_ = 0;
    std::uint32_t older_in_a_row_ = 0;
};

/// What a publisher does wrong, in words for the person who wrote it.
std::string words_for(const FrameIntake::Complaint& complaint);

}  // namespace quorient::intake
