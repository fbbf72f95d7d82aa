#include "motion.hpp"

#include "quorient/messages/units.hpp"

#include <array>

namespace quorient::system {

using namespace configuration;

namespace {

using MotionKind = MotionSection::Kind;
using simulation::Coning;

constexpr std::array<settings::Setting<Coning>, 4> coning{{
    {"k2", &Coning::k2, "rad/s", {}, "Rate about an axis that turns in the y-z plane."},
    {"k3", &Coning::k3, "rad/s", {}, "Rate about the x axis, and of that turning."},
    {"mu", &Coning::mu, "", {}, "Parameter of the attitude's closed form; mu^2 + nu^2 = 1."},
    {"nu", &Coning::nu, "", {}, "Parameter of the attitude's closed form; mu^2 + nu^2 = 1."},
}};

constexpr std::array<settings::Setting<MotionSection>, 2> classic_coning{{
    {"half_angle_deg", &MotionSection::half_angle_deg, "deg", {.lowest = 0, .highest = 180}, "Half the opening of the cone."},
    {"frequency_hz", &MotionSection::frequency_hz, "Hz", settings::not_negative, "Turns about the cone."},
}};

constexpr std::array<settings::Setting<MotionSection>, 3> random{{
    {"bandwidth_hz", &MotionSection::bandwidth_hz, "Hz", settings::above_zero, "Highest frequency of the angles."},
    {"rms_deg_s", &MotionSection::rms_deg_s, "deg/s", settings::not_negative, "Root mean square of the rate about each axis."},
    {"seed", &MotionSection::seed, "", {}, "The same seed gives the same motion."},
}};

template <MotionKind kind>
bool is(const MotionSection& motion)
{
    return motion.kind == kind;
}

}  // namespace

const Table<MotionSection>& motion_table()
{
    static const Table<MotionSection> table{
        "How the simulated body turns.",
        {word<MotionSection, MotionKind>({.name = "kind", .sentence = "Form of the motion."}, "motion", &MotionSection::kind,
                                         {{"rest", MotionKind::rest},
                                          {"turn", MotionKind::turn},
                                          {"coning", MotionKind::coning},
                                          {"classic-coning", MotionKind::classic_coning},
                                          {"random", MotionKind::random}})},
        {{"kind: turn", "A constant rate about a fixed axis.", is<MotionKind::turn>,
          value({.name = "rate_deg_s", .unit = "deg/s", .sentence = "Rate in the body frame."}, &MotionSection::rate_deg_s)},
         {"kind: coning", "The formal motion of paper 003, eqs 46-48.", is<MotionKind::coning>,
          all_of(&MotionSection::coning, record<Coning>(coning))},
         {"kind: classic-coning", "The body's x axis on a cone about the reference's x axis, without spin.", is<MotionKind::classic_coning>,
          record<MotionSection>(classic_coning)},
         {"kind: random", "Three successive rotations whose angles are sums of sinusoids.", is<MotionKind::random>,
          record<MotionSection>(random)}}};
    return table;
}

tl::expected<simulation::Motion, std::string> motion_of(const MotionSection& section)
{
    switch (section.kind) {
        case MotionKind::turn:
            return simulation::checked(simulation::Turn{Eigen::Vector3d(section.rate_deg_s.data()) * degree});
        case MotionKind::coning:
            return simulation::checked(section.coning);
        case MotionKind::classic_coning:
            return simulation::checked(simulation::ClassicConing{section.half_angle_deg * degree, section.frequency_hz});
        case MotionKind::random:
            return simulation::checked(simulation::RandomMotion{section.bandwidth_hz, section.rms_deg_s * degree, section.seed});
        case MotionKind::rest:
            break;
    }
    return simulation::checked(simulation::Rest{});
}

}  // namespace quorient::system
