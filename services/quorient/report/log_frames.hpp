#pragma once

#include "frame_store.hpp"
#include "quorient/diagnosis/diagnose.hpp"
#include "quorient/recording/aligned_logs.hpp"
#include "quorient/recording/survey.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::cli {

/// Logs with their survey and their compared instruments' frames. The logs are read once for the frames; then
/// these come from a store.
class SurveyedFrames final : public diagnosis::Frames {
public:
    /// @returns an error as survey, tie_clocks and AlignedLogs::open do
    static tl::expected<SurveyedFrames, std::string> read(const std::vector<std::filesystem::path>& files, const recording::LogOptions& options);

    const recording::Survey& survey() const { return survey_; }
    void each(const std::function<void(const recording::AlignedFrame&)>& visit) override;
    double interval_s() const override { return interval_s_; }

private:
    explicit SurveyedFrames(recording::Survey survey) : survey_(std::move(survey)), store_(survey_.compared.size()) {}

    recording::Survey survey_;
    std::optional<recording::AlignedLogs> opened_;  ///< for the first reading
    double interval_s_ = 0;
    FrameStore store_;
    bool stored_ = false;    ///< all frames are in the store
    bool storable_ = true;   ///< there was room for them so far
};

}  // namespace quorient::cli
