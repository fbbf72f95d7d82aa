#include "peers.hpp"

#include "rates.hpp"

#include <fmt/format.h>

namespace quorient::diagnosis {
namespace {

constexpr double begins_at_rest_s = 0.5;

Mountings nominal(const Overview& overview, const std::vector<recording::SurveyedInstrument>& instruments)
{
    Mountings mountings;
    for (std::size_t m = 0; m < overview.instruments(); ++m) {
        Mountings::One one;
        one.nominal = nominal_mounting(instruments[m].instrument);
        one.turned = one.nominal;
        mountings.of.push_back(one);
    }
    return mountings;
}

}  // namespace

Peers::Peers(const Overview& overview, const std::vector<recording::SurveyedInstrument>& instruments, double interval_s)
    : as_logged_(nominal(overview, instruments), instruments, {}, interval_s), px4_(as_logged_.cluster()),
      bias_rad_s_(overview.instruments(), Eigen::Vector3d::Zero())
{
    const bool rested = !overview.rests().empty() && overview.rests().front().from_s - overview.first_s() < begins_at_rest_s;
    if (!rested) return;
    rest_until_s_ = overview.rests().front().to_s;
    for (std::size_t m = 0; m < overview.instruments(); ++m) bias_rad_s_[m] = overview.first_rest_mean(m);
}

void Peers::add(const recording::AlignedFrame& frame)
{
    if ((frame.valid_mask & as_logged_.cluster().all()) != as_logged_.cluster().all()) return;
    const double time_s = static_cast<double>(frame.time_ns) * 1e-9;
    SensorFrame sensor;
    sensor.interval_s = frame.interval_s;
    std::array<Eigen::Vector3d, recording::max_triads> rates;
    for (std::size_t m = 0; m < as_logged_.instruments(); ++m) {
        const Eigen::Vector3d unbiased = (as_logged_.measured(frame, m) - bias_rad_s_[m]) * frame.interval_s;
        for (std::size_t i = 0; i < 3; ++i) sensor.increment[3 * m + i] = unbiased(static_cast<Eigen::Index>(i));
        rates[m] = as_logged_.common(frame, m);
    }
    if (time_s <= rest_until_s_) ardupilot_.update(time_s, std::span(rates).first(as_logged_.instruments()));
    if (px4_blames_ || as_logged_.instruments() < 3) return;
    px4_ran_ = true;
    const AxisMask blamed = px4_.update(sensor);
    if (blamed == 0) return;
    for (std::size_t m = 0; m < as_logged_.instruments(); ++m)
        if (has_axis(blamed, 3 * m)) px4_blames_ = m;
    px4_at_s_ = time_s;
}

std::vector<PeerFinding> Peers::findings(const std::vector<std::string>& names) const
{
    std::vector<PeerFinding> found;
    PeerFinding px4{"PX4", "nothing", std::nullopt};
    if (px4_blames_) {
        px4.finding = fmt::format("would have called {} faulty", names[*px4_blames_]);
        px4.at_s = px4_at_s_;
    } else if (!px4_ran_) {
        px4.finding = "compares three gyros or more: no verdict with fewer";
    }
    found.push_back(px4);
    PeerFinding ardupilot{
        "ArduPilot",
        "would have armed: before the first motion all gyros are within 5 deg/s of the first one (in flight it does not compare them)",
        std::nullopt};
    if (names.size() < 2) ardupilot.finding = "has one gyro: nothing to compare";
    else if (!(rest_until_s_ > 0)) ardupilot.finding = "compares gyros before arming only, and the log begins in motion";
    if (const auto& refusal = ardupilot_.refusal()) {
        ardupilot.finding = fmt::format(
            "would have refused to arm: {} differs from {} by {:.1f} deg/s as logged, more than 5 (in flight it does not compare them)",
            names[refusal->gyro], names.front(), refusal->difference_rad_s / degree);
        ardupilot.at_s = refusal->at_s;
    }
    found.push_back(ardupilot);
    return found;
}

}  // namespace quorient::diagnosis
