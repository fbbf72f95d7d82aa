#include "imu_alignment.hpp"

#include "quorient/messages/time.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::sensor {

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/// Clocks drift apart by less than this even while NTP slews one of them (500 ppm).
constexpr std::int64_t slew_divisor = 1000;

/// A common clock that is off by more than a second for half a second has been set.
constexpr std::int64_t step_ns = second_ns;
constexpr std::int64_t step_patience_ns = second_ns / 2;

/// Whose message is older does not vote on the clock.
constexpr std::int64_t fresh_ns = second_ns / 2;

}  // namespace

ImuAlignment::ImuAlignment(const system::Ros2SourceSettings& settings, SensorKind kind, double interval_s)
    : settings_(settings),
      kind_(kind),
      interval_ns_(nanoseconds(interval_s)),
      skew_ns_(nanoseconds(settings.skew_s)),
      received_(settings.imus.size()),
      instruments_(settings.imus.size())
{
}

void ImuAlignment::blame(Received& received, Fault fault, std::int64_t arrival_ns) const
{
    received.fault = fault;
    received.faulty_until_ns = arrival_ns + 2 * skew_ns_;  // until the frames that it touches are out
}

/// The rate; or the specific force, moved from the IMU's place to the body's origin: f_0 = f - alpha x r - omega x (omega x r).
Eigen::Vector3d ImuAlignment::value_of(std::size_t imu, Received& received, const bus::ros2::Imu& message) const
{
    const Eigen::Vector3d rate(message.rate_rad_s[0], message.rate_rad_s[1], message.rate_rad_s[2]);
    if (kind_ != SensorKind::accelerometer) return rate;
    const Eigen::Vector3d force(message.acceleration_m_s2[0], message.acceleration_m_s2[1], message.acceleration_m_s2[2]);
    const double since_s = static_cast<double>(message.stamp_ns - received.rate_stamp_ns) * 1e-9;
    const Eigen::Vector3d alpha =
        received.rate_stamp_ns != 0 && since_s > 0 ? Eigen::Vector3d((rate - received.rate_rad_s) / since_s) : Eigen::Vector3d::Zero();
    received.rate_rad_s = rate;
    received.rate_stamp_ns = message.stamp_ns;
    const auto& place = settings_.imus[imu];
    const Eigen::Vector3d arm = place.mounting.transpose() * place.position_m;  // in the IMU's frame
    return force - alpha.cross(arm) - rate.cross(rate.cross(arm));
}

void ImuAlignment::add(std::size_t imu, const bus::ros2::Imu& message, std::int64_t arrival_ns, std::uint32_t publishers)
{
    auto& received = received_[imu];
    if (received.first_arrival_ns == 0) received.first_arrival_ns = arrival_ns;
    const bool again = message.stamp_ns == received.stamp_ns;
    received.stamp_ns = message.stamp_ns;
    received.offset_ns = message.stamp_ns - arrival_ns;
    received.arrival_ns = arrival_ns;
    if (publishers > 1 || again) return blame(received, Fault::duplicated, arrival_ns);
    if (offset_ns_ && std::abs(received.offset_ns - *offset_ns_) > skew_ns_) return blame(received, Fault::skewed, arrival_ns);
    const ImuSample sample{message.stamp_ns, value_of(imu, received, message)};
    if (!sample.value.allFinite()) return blame(received, Fault::not_finite, arrival_ns);
    if (!received.stream.add(sample)) blame(received, Fault::disordered, arrival_ns);
}

bool ImuAlignment::ready(std::int64_t now_ns) const
{
    const auto received_for = [&](const Received& received) { return received.first_arrival_ns == 0 ? -1 : now_ns - received.first_arrival_ns; };
    return std::ranges::all_of(received_, [&](const Received& received) { return received_for(received) > 2 * skew_ns_; }) ||
           std::ranges::any_of(received_, [&](const Received& received) { return received_for(received) > second_ns; });
}

/// The median; with an even number, the middle one that is nearer to the clock so far: one of two that jumps does not take the clock with it.
std::optional<std::int64_t> ImuAlignment::median_offset(std::int64_t now_ns) const
{
    std::array<std::int64_t, max_axes> offsets{};
    std::size_t count = 0;
    for (const auto& received : received_) {
        if (received.first_arrival_ns != 0 && now_ns - received.arrival_ns < fresh_ns) offsets[count++] = received.offset_ns;
    }
    if (count == 0) return std::nullopt;
    std::sort(offsets.begin(), offsets.begin() + static_cast<std::ptrdiff_t>(count));
    const auto lower = offsets[(count - 1) / 2], upper = offsets[count / 2];
    if (!offset_ns_) return upper;  // the least late of the two
    return std::abs(lower - *offset_ns_) < std::abs(upper - *offset_ns_) ? lower : upper;
}

void ImuAlignment::start(std::int64_t now_ns)
{
    offset_ns_ = median_offset(now_ns).value_or(0);
    begin_ns_ = end_ns_ = now_ns + *offset_ns_ - skew_ns_;
}

void ImuAlignment::follow_clock(std::int64_t now_ns)
{
    const auto median = median_offset(now_ns);
    if (!median) return;
    const auto error = *median - *offset_ns_;
    if (std::abs(error) < step_ns) stepped_since_ns_ = 0;
    else if (stepped_since_ns_ == 0) stepped_since_ns_ = now_ns;
    if (stepped_since_ns_ != 0 && now_ns - stepped_since_ns_ > step_patience_ns) {
        // What turned meanwhile is in no frame; the frames' own time goes on without a step.
        offset_ns_ = *median;
        end_ns_ = now_ns + *offset_ns_ - skew_ns_ - interval_ns_;
        stepped_since_ns_ = 0;
        ++clock_steps_;
        for (auto& received : received_) received.stream.clear();
        return;
    }
    const auto slew = std::clamp(error, -interval_ns_ / slew_divisor, interval_ns_ / slew_divisor);
    *offset_ns_ += slew;
    end_ns_ += slew;
}

void ImuAlignment::advance(std::int64_t now_ns)
{
    begin_ns_ = end_ns_;
    const auto steps = clock_steps_;
    follow_clock(now_ns);
    end_ns_ += interval_ns_;
    if (clock_steps_ != steps) begin_ns_ = end_ns_ - interval_ns_;
    for (std::size_t imu = 0; imu < received_.size(); ++imu) {
        const auto& received = received_[imu];
        auto& instrument = instruments_[imu];
        const bool faulty = now_ns < received.faulty_until_ns;
        const bool whole = received.stream.integrate(begin_ns_, end_ns_, skew_ns_, instrument.increment);
        const bool finite = instrument.increment.allFinite();  // large numbers overflow in sums and differences
        instrument.valid = !faulty && whole && finite;
        instrument.fault = instrument.valid ? Fault::none : faulty ? received.fault : whole ? Fault::not_finite : Fault::silent;
    }
}

std::string_view to_string(ImuAlignment::Fault fault)
{
    switch (fault) {
        case ImuAlignment::Fault::none:
            return "measures";
        case ImuAlignment::Fault::silent:
            return "silent, or has gaps above skew_s";
        case ImuAlignment::Fault::skewed:
            return "its stamps are off the common clock by more than skew_s";
        case ImuAlignment::Fault::disordered:
            return "its stamps step back";
        case ImuAlignment::Fault::duplicated:
            return "duplicated: two publishers on its topic, or every stamp twice";
        case ImuAlignment::Fault::not_finite:
            return "sends values that are no numbers";
    }
    return "unknown";
}

}  // namespace quorient::sensor
