#include "bytes.hpp"
#include "imu_alignment.hpp"
#include "require.hpp"
#include "targets.hpp"

namespace quorient::fuzz {

void imus(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes{data, size};
    system::Ros2SourceSettings settings;
    settings.imus.resize(4);
    const auto kind = bytes.below(2) == 0 ? SensorKind::gyro : SensorKind::accelerometer;
    sensor::ImuAlignment alignment{settings, kind, 0.005};
    std::int64_t now = 1'000'000'000;
    bool started = false;
    std::int64_t last_end = 0;
    while (!bytes.empty()) {
        now += 5'000'000;
        for (std::size_t imu = 0; imu < settings.imus.size(); ++imu) {
            bus::ros2::Imu message;
            message.stamp_ns = now + 1'700'000'000'000'000'000;
            message.rate_rad_s = {0.1, 0.2, 0.3};
            const auto what = bytes.below(24);
            // ROS 2 has 32-bit seconds: no stamp reaches further.
            if (what == 0) message.stamp_ns = static_cast<std::int64_t>(nasty<std::int32_t>(bytes)) * 1'000'000'000 + bytes.below(60000);
            if (what == 1) spoil(message.rate_rad_s, bytes);
            if (what == 2) spoil(message.acceleration_m_s2, bytes);
            if (what != 3) alignment.add(imu, message, now, what == 4 ? 2 : 1);
        }
        if (!started && alignment.ready(now)) {
            alignment.start(now);
            started = true;
        }
        if (!started) continue;
        const auto steps = alignment.clock_steps();
        alignment.advance(now);
        REQUIRE(alignment.end_ns() > alignment.begin_ns());
        REQUIRE(last_end == 0 || alignment.begin_ns() == last_end || alignment.clock_steps() != steps);
        last_end = alignment.end_ns();
        for (const auto& instrument : alignment.instruments()) REQUIRE(!instrument.valid || instrument.increment.allFinite());
    }
}

}  // namespace quorient::fuzz
