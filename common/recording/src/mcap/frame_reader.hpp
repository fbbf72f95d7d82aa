#pragma once

#include "quorient/messages/identity.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/recording/reader.hpp"
#include "record_stream.hpp"

#include <deque>
#include <map>
#include <string_view>

namespace quorient::recording::mcap {

/// The longest loss of frames that is bridged; beyond it the recording was stopped and continued, and the rotation between is not known.
inline constexpr double longest_gap_s = 3600;

/// The frames of one unit's gyros in an MCAP file that `quorient record` wrote, or that another tool made of such a file: bit for bit as they
/// came from the wire, with the truth where the file has it. The unit is that of the first frame. A publisher that started again has another
/// clock and an unknown attitude: frames of its later epochs are refused.
class FrameReader final : public Reader {
public:
    /// Looks at the first 64 MB.
    /// @returns nothing if they name no channel of frames, and then the input is at its beginning; an error if there is no frame of
    /// gyros, or nothing that can be decompressed
    static std::optional<tl::expected<std::unique_ptr<FrameReader>, std::string>> open(Input& input, std::string name);

    /// The description is the file's own. Its biases are 0, since the publisher has subtracted them; its initial attitude is known only where the
    /// file begins with the epoch's first frame.
    ReadOutcome next(RecordedFrame& frame) override;

    double progress() const { return records_.progress(); }

    Identity first() const { return first_; }                        ///< the first frame's
    std::int64_t origin_ns() const { return origin_ns_; }            ///< where time_ns counts from, on the publisher's clock
    std::uint64_t given_sequence() const { return given_sequence_; }  ///< that of the latest frame from next()

private:
    enum class Topic { cluster, frame, truth };

    /// What the file's beginning says.
    struct Beginning {
        bool has_channel = false;
        std::optional<SensorFrame> frame;
        std::vector<ClusterDescription> descriptions;  // any unit's
    };

    FrameReader(Input input, std::string name);

    Beginning look();
    bool look_at_record(Beginning& beginning);
    void begin_with(const SensorFrame& first, const std::vector<ClusterDescription>& descriptions);

    static std::optional<Topic> topic_named(std::string_view schema);
    std::optional<Topic> topic_of(std::uint16_t channel) const;
    void add_names();
    std::optional<ReadOutcome> record();
    std::optional<ReadOutcome> accept(const SensorFrame& frame);
    std::optional<ReadOutcome> judge(const SensorFrame& frame);
    void accept(const TruthState& truth);
    bool is_ready() const;
    ReadOutcome give(RecordedFrame& frame);
    ReadOutcome refuse(std::string_view why);
    ReadOutcome refuse_as(std::uint64_t& reason, std::string_view why);

    /// A frame that waits for its truth, which may stand behind it in the file.
    struct Waiting {
        SensorFrame frame;
        std::uint64_t lost_before = 0;
        std::uint64_t position = 0;
    };

    RecordStream records_;
    std::string name_;
    std::map<std::uint16_t, Topic> schemas_;        // those that are looked for
    bool met_schema_ = false;                       // whatever its name
    std::map<std::uint16_t, Topic> topics_;         // by channel
    SensorFrame latest_;                            // the first frame until there is another; its epoch and unit are those of all
    Identity first_;
    std::int64_t origin_ns_ = 0;  // begin of the first frame's interval
    std::uint64_t given_sequence_ = 0;
    bool started_ = false;
    bool ended_ = false;
    std::deque<Waiting> waiting_;
    std::deque<TruthState> truths_;
};

}  // namespace quorient::recording::mcap
