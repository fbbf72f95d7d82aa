#include "report/log_frames.hpp"

#include "cli/program.hpp"

namespace quorient::cli {
namespace {

constexpr std::size_t most_bytes = 100'000'000;

}  // namespace

tl::expected<SurveyedFrames, std::string> SurveyedFrames::read(const std::vector<std::filesystem::path>& files, const recording::LogOptions& options)
{
    auto survey = recording::survey(files, options);
    if (!survey) return tl::unexpected(survey.error());
    if (auto tied = recording::tie_clocks(*survey); !tied) return tl::unexpected(tied.error());
    SurveyedFrames frames(std::move(*survey));
    if (frames.survey_.compared.empty()) return frames;
    auto opened = recording::AlignedLogs::open(frames.survey_);
    if (!opened) return tl::unexpected(opened.error());
    frames.interval_s_ = opened->interval_s();
    frames.opened_.emplace(std::move(*opened));
    return frames;
}

void SurveyedFrames::each(const std::function<void(const recording::AlignedFrame&)>& visit)
{
    if (complete_) return each_kept(visit);
    if (!opened_) {
        auto opened = recording::AlignedLogs::open(survey_);
        if (!opened) fail(opened.error());
        opened_.emplace(std::move(*opened));
    }
    recording::AlignedFrame frame;
    for (auto outcome = opened_->next(frame); outcome != recording::ReadOutcome::end; outcome = opened_->next(frame)) {
        if (outcome != recording::ReadOutcome::frame) continue;  // the survey has counted it
        keep(frame);
        visit(frame);
    }
    opened_.reset();
    complete_ = !too_many_;
}

void SurveyedFrames::keep(const recording::AlignedFrame& frame)
{
    if (too_many_) return;
    kept_.push_back({frame.time_ns, static_cast<float>(frame.interval_s), frame.valid_mask, frame.clipped_mask, frame.after_gap});
    for (std::size_t m = 0; m < frame.count; ++m)
        for (const double rate : frame.rate_rad_s[m]) rates_rad_s_.push_back(static_cast<float>(rate));
    too_many_ = kept_.size() * sizeof(Kept) + rates_rad_s_.size() * sizeof(float) > most_bytes;
    if (!too_many_) return;
    std::vector<Kept>().swap(kept_);
    std::vector<float>().swap(rates_rad_s_);
}

void SurveyedFrames::each_kept(const std::function<void(const recording::AlignedFrame&)>& visit) const
{
    recording::AlignedFrame frame;
    frame.count = survey_.compared.size();
    auto rate = rates_rad_s_.begin();
    for (const Kept& kept : kept_) {
        frame.time_ns = kept.time_ns;
        frame.interval_s = static_cast<double>(kept.interval_s);
        frame.valid_mask = kept.valid_mask;
        frame.clipped_mask = kept.clipped_mask;
        frame.after_gap = kept.after_gap;
        for (std::size_t m = 0; m < frame.count; ++m)
            for (double& value : frame.rate_rad_s[m]) value = static_cast<double>(*rate++);
        visit(frame);
    }
}

}  // namespace quorient::cli
