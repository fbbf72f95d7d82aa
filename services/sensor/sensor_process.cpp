#include "sensor_process.hpp"

#include "frame_source.hpp"
#include "sensor_publisher.hpp"

namespace quorient::sensor {
namespace {

struct Publishing final : host::Hosted {
    Publishing(const system::SensorSettings& settings, std::unique_ptr<FrameSource> source, bus::Bus& bus, runtime::EventLoop& loop)
        : publisher(settings, std::move(source), bus, loop)
    {
    }
    SensorPublisher publisher;
};

}  // namespace

tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string&)
{
    const runtime::SystemClock clock;
    auto made = make_source(system.sensor, static_cast<std::uint64_t>(clock.wall_ns()));
    if (!made) return tl::unexpected(made.error());
    const auto source = std::make_shared<std::unique_ptr<FrameSource>>(std::move(*made));
    return host::Process{system.sensor.process, [settings = system.sensor, source](bus::Bus& bus, runtime::EventLoop& loop) {
                             return std::make_unique<Publishing>(settings, std::move(*source), bus, loop);
                         }};
}

}  // namespace quorient::sensor
