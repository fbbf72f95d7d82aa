#include "record_parts.hpp"

#include "add_statistics.hpp"
#include "open_input.hpp"

#include <algorithm>

namespace quorient::recording::mcap {
namespace {

class RecordParts final : public Reader {
public:
    /// @param parts  of one unit and epoch, in the order of their first frames
    explicit RecordParts(std::vector<std::unique_ptr<FrameReader>> parts) : parts_(std::move(parts)), origin_ns_(parts_.front()->origin_ns())
    {
        description_ = parts_.front()->description();
    }

    ReadOutcome next(RecordedFrame& frame) override
    {
        while (at_ < parts_.size()) {
            FrameReader& part = *parts_[at_];
            const auto outcome = part.next(frame);
            add_up();
            if (outcome == ReadOutcome::rejected) problem_ = part.problem();
            if (outcome == ReadOutcome::rejected) return outcome;
            if (outcome == ReadOutcome::end) ++at_;
            else if (const auto given = continue_with(part, frame)) return *given;
        }
        return ReadOutcome::end;
    }

private:
    /// Puts a part's frame behind those of the parts before, by the rules of a single file. @returns nothing where they have it already
    std::optional<ReadOutcome> continue_with(const FrameReader& part, RecordedFrame& frame)
    {
        const std::uint64_t sequence = part.given_sequence();
        frame.time_ns += part.origin_ns() - origin_ns_;
        if (given_ && sequence <= *given_) return std::nullopt;
        const bool forward = !given_ || frame.time_ns > statistics_.duration_ns;
        const bool near = !given_ || static_cast<double>(sequence - *given_ - 1) * frame.interval_s <= longest_gap_s;
        if (!forward || !near) {
            ++refused_between_;
            add_up();
            problem_ = "a part that continues another one more than an hour later, or earlier in time: the rotation between is not known";
            return ReadOutcome::rejected;
        }
        if (given_) frame.lost_before = sequence - *given_ - 1;
        between_ += given_ && at_ != given_in_ ? frame.lost_before : 0;
        given_ = sequence;
        given_in_ = at_;
        add_up();
        statistics_.duration_ns = frame.time_ns;
        return ReadOutcome::frame;
    }

    void add_up()
    {
        const std::int64_t duration_ns = statistics_.duration_ns;
        statistics_ = {};
        for (const auto& part : parts_) add(statistics_, part->statistics());
        statistics_.lost += between_;
        statistics_.irregular += refused_between_;
        statistics_.duration_ns = duration_ns;
    }

    std::vector<std::unique_ptr<FrameReader>> parts_;
    std::int64_t origin_ns_;
    std::size_t at_ = 0;                  // part in hand
    std::optional<std::uint64_t> given_;  // sequence of the frame given out last …
    std::size_t given_in_ = 0;            // … and its part
    std::uint64_t between_ = 0;           // frames missing between two parts
    std::uint64_t refused_between_ = 0;   // frames of a part that does not continue the one before
};

}  // namespace

std::optional<std::unique_ptr<Reader>> open_parts(std::span<const std::filesystem::path> files)
{
    std::vector<std::unique_ptr<FrameReader>> parts;
    for (const auto& file : files) {
        auto input = std::filesystem::is_directory(file) ? tl::unexpected(std::string{}) : open_input(file);
        if (!input || !is_mcap(input->peek(magic.size()))) return std::nullopt;
        auto part = FrameReader::open(*input, file.filename().string());
        if (!part || !*part) return std::nullopt;
        parts.push_back(std::move(**part));
    }
    const auto first = [](const auto& part) { return part->first(); };
    const auto belongs = [&](const auto& part) {
        return first(part).epoch == first(parts.front()).epoch && part->description().unit == parts.front()->description().unit &&
               part->description().axis_count == parts.front()->description().axis_count;
    };
    if (parts.empty() || !std::all_of(parts.begin(), parts.end(), belongs)) return std::nullopt;
    std::sort(parts.begin(), parts.end(), [&](const auto& a, const auto& b) { return first(a) < first(b); });
    return std::make_unique<RecordParts>(std::move(parts));
}

}  // namespace quorient::recording::mcap
