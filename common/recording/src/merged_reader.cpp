#include "quorient/recording/merge.hpp"

#include "add_statistics.hpp"
#include "aligned_reader.hpp"
#include "mcap/record_parts.hpp"
#include "quorient/messages/time.hpp"
#include "readers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <deque>

namespace quorient::recording {
namespace {

/// Stamps come in microseconds.
constexpr std::int64_t stamp_rounding_ns = 1000;

/// Devices are switched on and off one after the other: a log that begins later or ends earlier than the others by no more than this
/// did not fail, and the common log begins and ends with it.
constexpr std::int64_t switching_ns = 1'000'000'000;

/// One log beside the first: its frames around the time in hand, on the first log's clock.
class Follower {
public:
    Follower(std::unique_ptr<Reader> reader, double offset_s) : reader_(std::move(reader)), offset_ns_(nanoseconds(offset_s)) {}

    /// Reads everything up to this time. @returns rejected if a record was refused: call again.
    ReadOutcome reach(std::int64_t begin_ns, std::int64_t end_ns)
    {
        while (!frames_.empty() && frames_.front().time_ns <= begin_ns) frames_.pop_front();
        while (!ended_ && (frames_.empty() || frames_.back().time_ns < end_ns)) {
            RecordedFrame frame;
            const auto outcome = reader_->next(frame);
            if (outcome == ReadOutcome::rejected) return outcome;
            ended_ = outcome == ReadOutcome::end;
            frame.time_ns -= offset_ns_;
            if (!ended_ && frame.time_ns > begin_ns) frames_.push_back(frame);
        }
        return ReadOutcome::frame;
    }

    /// After reach(): whether it had begun by then, and whether it has ended before.
    bool begun(std::int64_t begin_ns) const
    {
        return frames_.empty() || frames_.front().time_ns - nanoseconds(frames_.front().interval_s) <= begin_ns + stamp_rounding_ns;
    }
    bool over(std::int64_t end_ns) const { return ended_ && (frames_.empty() || frames_.back().time_ns < end_ns - stamp_rounding_ns); }

    /// Adds its axes behind those that the frame has; they are valid where its own frames cover the interval without a hole.
    void add_to(RecordedFrame& frame, std::int64_t begin_ns) const
    {
        const std::size_t count = reader_->description().axis_count;
        const std::size_t first = frame.axis_count;
        for (std::size_t axis = 0; axis < count; ++axis) frame.increment[first + axis] = frame.acceleration_m_s2[first + axis] = 0;
        AxisMask valid = all_axes(count);
        AxisMask acceleration = all_axes(count);
        std::int64_t covered_ns = 0;
        for (const RecordedFrame& own : frames_) {
            const std::int64_t own_begin_ns = own.time_ns - nanoseconds(own.interval_s);
            const std::int64_t overlap_ns = std::min(own.time_ns, frame.time_ns) - std::max(own_begin_ns, begin_ns);
            if (overlap_ns <= 0) continue;
            covered_ns += overlap_ns;
            valid &= own.valid_mask;
            acceleration &= own.acceleration_mask;
            const double share = static_cast<double>(overlap_ns) * 1e-9 / own.interval_s;
            const double weight = static_cast<double>(overlap_ns) / static_cast<double>(frame.time_ns - begin_ns);
            for (std::size_t axis = 0; axis < count; ++axis) {
                frame.increment[first + axis] += share * own.increment[axis];
                frame.acceleration_m_s2[first + axis] += weight * own.acceleration_m_s2[axis];
            }
        }
        frame.axis_count += count;
        if (frame.time_ns - begin_ns - covered_ns > stamp_rounding_ns) return;
        frame.valid_mask |= valid << first;
        frame.acceleration_mask |= acceleration << first;
    }

    const Reader& reader() const { return *reader_; }

private:
    std::unique_ptr<Reader> reader_;
    std::int64_t offset_ns_;
    std::deque<RecordedFrame> frames_;  // few: those that touch the interval in hand
    bool ended_ = false;
};

class MergedReader final : public Reader {
public:
    MergedReader(std::unique_ptr<Reader> leader, std::vector<Follower> followers)
        : leader_(std::move(leader)), followers_(std::move(followers))
    {
        description_ = leader_->description();
        for (const Follower& follower : followers_) append(follower.reader().description());
    }

    ReadOutcome next(RecordedFrame& frame) override
    {
        for (;;) {
            if (failed_ && !held_.empty()) {
                frame = held_.front();
                held_.pop_front();
                return give_out(frame);
            }
            const auto outcome = merge(frame);
            if (outcome != ReadOutcome::frame) return outcome;  // at the end, what is held was the switching off
            const std::int64_t begin_ns = frame.time_ns - nanoseconds(frame.interval_s);
            if (frame.time_ns <= switching_ns && !all_begun(begin_ns)) continue;
            if (failed_ || !any_over(frame.time_ns)) return give_out(frame);
            held_.push_back(frame);
            failed_ = frame.time_ns - held_.front().time_ns > switching_ns;
        }
    }

private:
    bool all_begun(std::int64_t begin_ns) const
    {
        return std::all_of(followers_.begin(), followers_.end(), [&](const Follower& follower) { return follower.begun(begin_ns); });
    }

    bool any_over(std::int64_t end_ns) const
    {
        return std::any_of(followers_.begin(), followers_.end(), [&](const Follower& follower) { return follower.over(end_ns); });
    }

    ReadOutcome give_out(const RecordedFrame& frame)
    {
        ++frames_;
        if (frame.valid_mask != all_axes(frame.axis_count)) ++incomplete_;
        add_up();
        return ReadOutcome::frame;
    }

    /// The leader's next frame with what the followers measured meanwhile.
    ReadOutcome merge(RecordedFrame& frame)
    {
        if (!pending_) {
            const auto outcome = leader_->next(frame_);
            if (outcome != ReadOutcome::frame) return pass_on(outcome, *leader_);
            pending_ = true;
        }
        const std::int64_t begin_ns = frame_.time_ns - nanoseconds(frame_.interval_s);
        for (Follower& follower : followers_)
            if (follower.reach(begin_ns, frame_.time_ns) == ReadOutcome::rejected) return pass_on(ReadOutcome::rejected, follower.reader());
        frame = frame_;
        frame.truth.reset();
        for (const Follower& follower : followers_) follower.add_to(frame, begin_ns);
        pending_ = false;
        return ReadOutcome::frame;
    }

    void append(const ClusterDescription& other)
    {
        for (std::size_t axis = 0; axis < other.axis_count; ++axis) {
            const std::size_t place = description_.axis_count++;
            description_.axis[place] = other.axis[axis];
            description_.position_m[place] = other.position_m[axis];
            description_.quantum[place] = other.quantum[axis];
            description_.range[place] = other.range[axis];
            description_.instrument[place] = static_cast<std::uint8_t>(description_.instrument_count + other.instrument[axis]);
        }
        for (std::size_t i = 0; i < other.instrument_count; ++i)
            description_.instrument_name[description_.instrument_count++] = other.instrument_name[i];
    }

    ReadOutcome pass_on(ReadOutcome outcome, const Reader& from)
    {
        if (outcome == ReadOutcome::rejected) problem_ = from.problem();
        add_up();
        return outcome;
    }

    /// Refusals of all logs together; frames and duration are those given out.
    void add_up()
    {
        statistics_ = leader_->statistics();
        for (const Follower& follower : followers_) add(statistics_, follower.reader().statistics());
        statistics_.frames = frames_;
        statistics_.incomplete = incomplete_;
    }

    std::unique_ptr<Reader> leader_;
    std::vector<Follower> followers_;
    RecordedFrame frame_;
    bool pending_ = false;            // the leader's frame waits for the followers
    std::deque<RecordedFrame> held_;  // frames after a log's end, until it is clear whether it failed or all end; at most switching_ns
    bool failed_ = false;             // that log failed
    std::uint64_t frames_ = 0;
    std::uint64_t incomplete_ = 0;
};

}  // namespace

tl::expected<MergedLogs, std::string> open_logs(std::span<const std::filesystem::path> files, const LogOptions& options)
{
    if (files.empty()) return tl::unexpected(std::string("no log is named"));
    if (files.size() > 1) {
        if (auto parts = mcap::open_parts(files)) return MergedLogs{std::move(*parts), std::vector<ClockOffset>(files.size(), {0.0, 1.0}), {}};
    }
    std::vector<std::string> remarks;
    auto leader = open_log(files.front(), options, remarks);
    if (!leader) return tl::unexpected(leader.error());
    MergedLogs merged{nullptr, {{0.0, 1.0}}, {}};
    std::vector<Follower> followers;
    std::size_t axes = (*leader)->description().axis_count;
    for (const auto& file : files.subspan(1)) {
        const auto offset = estimate_offset(files.front(), file, 3.0, options);
        if (!offset) return tl::unexpected(offset.error());
        auto reader = open_log(file, options, remarks);
        if (!reader) return tl::unexpected(reader.error());
        axes += (*reader)->description().axis_count;
        if (axes > max_axes) return tl::unexpected(fmt::format("{}: more than {} axes together", file.string(), max_axes));
        followers.emplace_back(std::move(*reader), offset->offset_s);
        merged.offsets.push_back(*offset);
    }
    merged.remarks = std::move(remarks);
    merged.reader = followers.empty() ? std::move(*leader) : std::make_unique<MergedReader>(std::move(*leader), std::move(followers));
    return merged;
}

}  // namespace quorient::recording
