#include "aligned_reader.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/recording/aligned_logs.hpp"
#include "readers.hpp"

#include <cmath>
#include <span>

namespace quorient::recording {
namespace {

class AlignedReader final : public Reader {
public:
    AlignedReader(const Survey& survey, AlignedLogs logs) : logs_(std::move(logs))
    {
        description_.kind = octet(SensorKind::gyro);
        description_.interval_s = logs_.interval_s();
        copy_text(survey.files.front().stem().string(), description_.name);
        for (const std::size_t i : survey.compared) append(survey.instruments[i]);
    }

    ReadOutcome next(RecordedFrame& frame) override
    {
        AlignedFrame aligned;
        const auto outcome = logs_.next(aligned);
        if (outcome == ReadOutcome::rejected) {
            problem_ = logs_.problem();
            ++statistics_.records;
            ++statistics_.malformed;
        }
        if (outcome == ReadOutcome::frame) give(aligned, frame);
        return outcome;
    }

private:
    void append(const SurveyedInstrument& surveyed)
    {
        const Instrument& instrument = surveyed.instrument;
        for (std::size_t k = 0; k < instrument.axis.size(); ++k) {
            const std::size_t place = description_.axis_count++;
            description_.axis[place] = instrument.axis[k];
            description_.range[place] = surveyed.range_rad_s(k);
            description_.instrument[place] = description_.instrument_count;
        }
        copy_text(instrument.name, description_.instrument_name[description_.instrument_count++]);
    }

    void give(const AlignedFrame& aligned, RecordedFrame& frame)
    {
        const std::int64_t begin_ns = aligned.time_ns - nanoseconds(aligned.interval_s);
        if (!last_ns_) origin_ns_ = last_ns_ = begin_ns;
        frame = {};
        frame.time_ns = aligned.time_ns - *origin_ns_;
        frame.interval_s = aligned.interval_s;
        frame.axis_count = description_.axis_count;
        frame.valid_mask = aligned.valid_mask;
        frame.acceleration_mask = aligned.acceleration_mask;
        for (std::size_t axis = 0; axis < frame.axis_count; ++axis) {
            frame.increment[axis] = aligned.rate_rad_s[axis / 3][axis % 3] * aligned.interval_s;
            frame.acceleration_m_s2[axis] = aligned.acceleration_m_s2[axis / 3][axis % 3];
        }
        const double missing_s = static_cast<double>(begin_ns - *last_ns_) * 1e-9;
        frame.lost_before = static_cast<std::uint64_t>(std::llround(std::max(0.0, missing_s / description_.interval_s)));
        last_ns_ = aligned.time_ns;
        ++statistics_.records;
        ++statistics_.frames;
        statistics_.lost += frame.lost_before;
        statistics_.incomplete += frame.valid_mask == all_axes(frame.axis_count) ? 0 : 1;
        statistics_.duration_ns = frame.time_ns;
    }

    AlignedLogs logs_;
    std::optional<std::int64_t> origin_ns_;  // where the first frame begins
    std::optional<std::int64_t> last_ns_;    // where the frame before ended
};

}  // namespace

tl::expected<std::unique_ptr<Reader>, std::string> open_aligned(const std::filesystem::path& file, const LogOptions& options,
                                                                  std::vector<std::string>& remarks)
{
    auto found = survey(std::span(&file, 1), options);
    if (!found) return tl::unexpected(found.error());
    if (auto tied = tie_clocks(*found); !tied) return tl::unexpected(tied.error());
    for (const SurveyedLog& log : found->logs) remarks.insert(remarks.end(), log.remarks.begin(), log.remarks.end());
    remarks.insert(remarks.end(), found->remarks.begin(), found->remarks.end());
    auto logs = AlignedLogs::open(*found);
    if (!logs) return tl::unexpected(logs.error());
    return std::make_unique<AlignedReader>(*found, std::move(*logs));
}

}  // namespace quorient::recording
