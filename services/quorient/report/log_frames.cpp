#include "report/log_frames.hpp"

#include "cli/program.hpp"

namespace quorient::cli {

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
    if (stored_) {
        if (!store_.each(visit)) fail("the frames cannot be read back from the temporary file that holds them");
        return;
    }
    if (!opened_) {
        auto opened = recording::AlignedLogs::open(survey_);
        if (!opened) fail(opened.error());
        opened_.emplace(std::move(*opened));
    }
    recording::AlignedFrame frame;
    bool storing = storable_;
    for (auto outcome = opened_->next(frame); outcome != recording::ReadOutcome::end; outcome = opened_->next(frame)) {
        if (outcome != recording::ReadOutcome::frame) continue;  // the survey has counted it
        storing = storing && store_.add(frame);
        visit(frame);
    }
    opened_.reset();
    stored_ = storing && store_.flush();
    storable_ = stored_;
    if (!stored_) store_ = FrameStore(survey_.compared.size());  // there is no room: the logs are read again, now and later
}

}  // namespace quorient::cli
