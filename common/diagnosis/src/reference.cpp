#include "facts.hpp"
#include "fit.hpp"
#include "mounting.hpp"
#include "overview.hpp"
#include "rates.hpp"

#include "quorient/diagnosis/diagnose.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::diagnosis {
namespace {

/// A gain that is more certain than this is taken out of another log.
constexpr double removed_gain_sigma = 0.01;

/// The fit where it is certain, identity where nothing moved.
Eigen::Matrix3d known_part(const Fit& fit)
{
    Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
    for (Eigen::Index i = 0; i < 3; ++i)
        if (fit.gain_sigma(i) < removed_gain_sigma) gain.row(i) = fit.gain.row(i);
    return gain;
}

}  // namespace

tl::expected<std::vector<Calibration>, std::string> reference_of(const recording::Survey& survey, Frames& frames, const Options& options)
{
    const std::string& name = survey.logs.front().name;
    if (survey.compared.size() < 3)
        return tl::unexpected(fmt::format("{}: {} gyros at full rate; a healthy reference needs three or more", name, survey.compared.size()));
    Options alone = options;
    alone.reference.clear();
    const Report report = diagnose(survey, frames, alone);
    if (report.found_anything()) return tl::unexpected(fmt::format("{}: not a healthy log. {}", name, report.sentence));

    std::vector<recording::SurveyedInstrument> instruments;
    for (const std::size_t i : survey.compared) instruments.push_back(survey.instruments[i]);
    Overview overview(instruments.size());
    frames.each([&](const recording::AlignedFrame& frame) { overview.add(frame); });
    overview.finish();
    const Mountings mountings = find_mountings(overview, instruments);
    std::vector<Calibration> found;
    for (std::size_t m = 0; m < instruments.size(); ++m) {
        // Against the mean of all, itself included: then all are brought to one and the same frame and scale.
        const auto fit = fit_against(overview, mountings, m, (1U << instruments.size()) - 1);
        if (!fit) return tl::unexpected(fmt::format("{}: {} has too little data", name, instruments[m].instrument.name));
        Calibration calibration;
        calibration.name = instruments[m].instrument.name;
        calibration.bias_rad_s = overview.rest_bias(m).value_or(fit->bias_rad_s);
        calibration.gain = known_part(*fit);
        calibration.turned = mountings.of[m].turned;
        found.push_back(calibration);
    }
    return found;
}

}  // namespace quorient::diagnosis
