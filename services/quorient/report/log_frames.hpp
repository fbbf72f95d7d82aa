#pragma once

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

/// Logs with their survey and their compared instruments' frames. Frames are kept in memory where that takes less than 100 MB, and read again
/// from the logs where it does not.
class SurveyedFrames final : public diagnosis::Frames {
public:
    /// @returns an error as survey, tie_clocks and AlignedLogs::open do
    static tl::expected<SurveyedFrames, std::string> read(const std::vector<std::filesystem::path>& files, const recording::LogOptions& options);

    const recording::Survey& survey() const { return survey_; }
    void each(const std::function<void(const recording::AlignedFrame&)>& visit) override;
    double interval_s() const override { return interval_s_; }

private:
    /// A frame in few bytes; rates are in a list of their own.
    struct Kept {
        std::int64_t time_ns;
        float interval_s;
        AxisMask valid_mask;
        AxisMask clipped_mask;
        bool after_gap;
    };

    explicit SurveyedFrames(recording::Survey survey) : survey_(std::move(survey)) {}

    void keep(const recording::AlignedFrame& frame);
    void each_kept(const std::function<void(const recording::AlignedFrame&)>& visit) const;

    recording::Survey survey_;
    std::optional<recording::AlignedLogs> opened_;  ///< for the first reading
    double interval_s_ = 0;
    bool complete_ = false;  ///< all frames are kept
    bool too_many_ = false;
    std::vector<Kept> kept_;
    std::vector<float> rates_rad_s_;
};

}  // namespace quorient::cli
