#pragma once

#include "quorient/diagnosis/diagnose.hpp"

#include "field_scene.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <vector>

namespace quorient::diagnosis {

/// A scene's measurements as a log's frames.
class SceneFrames final : public Frames {
public:
    SceneFrames(fdi::FieldScene& scene, double seconds)
    {
        interval_s_ = scene.cluster.interval_s;
        const std::size_t instruments = scene.cluster.instrument_name.size();
        while (scene.time_s() < seconds) {
            const fdi::Measurement measurement = scene.next();
            recording::AlignedFrame frame;
            frame.time_ns = std::llround(scene.time_s() * 1e9);
            frame.interval_s = measurement.interval_s;
            frame.count = instruments;
            frame.valid_mask = measurement.valid;
            for (std::size_t axis = 0; axis < 3 * instruments; ++axis)
                frame.rate_rad_s[axis / 3][axis % 3] = has_axis(measurement.valid, axis) ? measurement.increment[axis] / measurement.interval_s : 0;
            frames_.push_back(frame);
        }
    }

    void each(const std::function<void(const recording::AlignedFrame&)>& visit) override
    {
        for (const auto& frame : frames_) visit(frame);
    }
    double interval_s() const override { return interval_s_; }

private:
    double interval_s_;
    std::vector<recording::AlignedFrame> frames_;
};

/// As a survey describes a log with this scene's instruments.
inline recording::Survey survey_of(const fdi::FieldScene& scene, double seconds)
{
    recording::Survey survey;
    survey.logs.push_back({});
    survey.logs.back().name = "scene";
    survey.logs.back().last_ns = std::llround(seconds * 1e9);
    for (std::size_t m = 0; m < scene.cluster.instrument_name.size(); ++m) {
        recording::SurveyedInstrument instrument;
        instrument.instrument.name = scene.cluster.instrument_name[m];
        instrument.place = m;
        instrument.figures.samples = static_cast<std::uint64_t>(seconds / scene.cluster.interval_s);
        instrument.figures.period_s = scene.cluster.interval_s;
        instrument.figures.last_ns = survey.logs.back().last_ns;
        instrument.figures.coverage = 1;
        survey.compared.push_back(m);
        survey.instruments.push_back(instrument);
    }
    return survey;
}

inline Report diagnose(fdi::FieldScene& scene, double seconds, const Options& options = {})
{
    SceneFrames frames(scene, seconds);
    return diagnose(survey_of(scene, seconds), frames, options);
}

inline std::vector<Finding> with(const Report& report, Certainty certainty)
{
    std::vector<Finding> found;
    for (const Finding& finding : report.findings)
        if (finding.certainty == certainty) found.push_back(finding);
    return found;
}

}  // namespace quorient::diagnosis
