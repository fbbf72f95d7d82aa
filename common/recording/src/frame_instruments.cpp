#include "frame_instruments.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::recording {
namespace {

template <class Frames>
class FrameInstruments final : public InstrumentLog {
public:
    FrameInstruments(std::unique_ptr<Frames> frames, std::string format) : frames_(std::move(frames))
    {
        format_ = std::move(format);
        const ClusterDescription& description = frames_->description();
        for (std::size_t i = 0; i < description.instrument_count; ++i) {
            Instrument instrument;
            const auto& name = description.instrument_name[i];
            instrument.name.assign(name.begin(), std::find(name.begin(), name.end(), '\0'));
            instrument.source = format_;
            instrument.stamps = StampKind::sampling;
            instrument.range_rad_s = description.range[3 * i];
            std::copy_n(description.axis.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, instrument.axis.begin());
            instruments_.push_back(std::move(instrument));
        }
        next_ = instruments_.size();
    }

    ReadOutcome next(InstrumentSample& sample) override
    {
        if (next_ == instruments_.size()) {
            const auto outcome = frames_->next(frame_);
            count(outcome);
            if (outcome != ReadOutcome::frame) return outcome;
            next_ = 0;
        }
        sample = {};
        sample.instrument = next_;
        sample.time_ns = frame_.time_ns;
        sample.covered_s = frame_.interval_s;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t axis = 3 * next_ + k;
            if (has_axis(frame_.valid_mask, axis)) sample.rate_rad_s[k] = frame_.increment[axis] / frame_.interval_s;
            if (has_axis(frame_.acceleration_mask, axis)) sample.acceleration_m_s2[k] = frame_.acceleration_m_s2[axis];
        }
        sample.position = frame_.position;
        ++next_;
        ++samples_;
        statistics_.frames = samples_;
        return ReadOutcome::frame;
    }

    double progress() const override { return frames_->progress(); }

private:
    void count(ReadOutcome outcome)
    {
        statistics_ = frames_->statistics();
        statistics_.frames = samples_;
        if (outcome == ReadOutcome::rejected) problem_ = frames_->problem();
    }

    std::unique_ptr<Frames> frames_;
    RecordedFrame frame_;
    std::uint64_t samples_ = 0;
    std::size_t next_ = 0;  // instrument of the frame in hand
};

}  // namespace

std::unique_ptr<InstrumentLog> frame_instruments(std::unique_ptr<MimuReader> frames, std::string format)
{
    return std::make_unique<FrameInstruments<MimuReader>>(std::move(frames), std::move(format));
}

tl::expected<std::unique_ptr<InstrumentLog>, std::string> frame_instruments(std::unique_ptr<mcap::FrameReader> frames, const std::string& name)
{
    const ClusterDescription& description = frames->description();
    bool triads = description.axis_count == 3 * description.instrument_count;
    for (std::size_t axis = 0; axis < description.axis_count; ++axis) triads = triads && description.instrument[axis] == axis / 3;
    if (!triads)
        return tl::unexpected(fmt::format("{}: a record of {} single axes, and instruments are compared by three; replay reads it", name,
                                          description.axis_count));
    return std::make_unique<FrameInstruments<mcap::FrameReader>>(std::move(frames), "Quorient's record");
}

}  // namespace quorient::recording
