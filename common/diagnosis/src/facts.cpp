#include "facts.hpp"

#include "fit.hpp"
#include "rates.hpp"

#include "quorient/rotation/nearest.hpp"

#include <limits>

namespace quorient::diagnosis {
namespace {

/// A gain that is less certain than this is not stated.
constexpr double stated_gain_sigma = 0.03;

/// The rotation in a matrix of gains.
Eigen::Matrix3d rotation_in(const Eigen::Matrix3d& gain)
{
    const Eigen::Matrix3d straight = rotation::nearest_orthogonal(gain);
    return straight.determinant() > 0 ? straight : Eigen::Matrix3d::Identity();
}

}  // namespace

std::vector<InstrumentFacts> logged_facts(const recording::Survey& survey)
{
    std::vector<InstrumentFacts> all;
    for (const recording::SurveyedInstrument& instrument : survey.instruments) {
        InstrumentFacts facts;
        facts.name = instrument.instrument.name;
        facts.figures = instrument.figures;
        facts.clock = instrument.clock;
        all.push_back(std::move(facts));
    }
    return all;
}

void add_rest_facts(const Overview& overview, std::size_t m, InstrumentFacts& facts)
{
    facts.compared = true;
    if (const auto bias = overview.rest_bias(m)) {
        facts.bias_deg_s = *bias / degree;
        facts.bias_from_rest = true;
    }
    if (const auto noise = overview.rest_noise(m)) facts.noise_rest_deg_s = *noise / degree;
}

void add_compared_facts(const Overview& overview, const Mountings& mountings, const Aftermath& aftermath, std::size_t m, std::uint32_t sound,
                        InstrumentFacts& facts)
{
    if (const auto noise = aftermath.noise_in_motion(m)) facts.noise_motion_deg_s = *noise / degree;
    facts.rotation = Eigen::Quaterniond(mountings.of[m].turned);
    const auto fit = fit_against(overview, mountings, m, sound & ~(1U << m));
    if (!fit) return;
    if (!facts.bias_deg_s) facts.bias_deg_s = fit->bias_rad_s / degree;
    Eigen::Vector3d gain = fit->gain.diagonal() * mountings.of[m].scale;
    for (Eigen::Index i = 0; i < 3; ++i)
        if (fit->gain_sigma(i) > stated_gain_sigma) gain(i) = std::numeric_limits<double>::quiet_NaN();
    facts.gain = gain;
    if (gain.allFinite()) facts.rotation = Eigen::Quaterniond(Eigen::Matrix3d(mountings.of[m].turned * rotation_in(fit->gain).transpose()));
}

}  // namespace quorient::diagnosis
