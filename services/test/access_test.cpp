// An identity permits exactly the topics that its service asks the bus for. With less the vendor would refuse the service at its start.

#include "detector_service.hpp"
#include "frame_source.hpp"
#include "integrator_service.hpp"
#include "quorient/system/members.hpp"
#include "rig.hpp"
#include "sensor_publisher.hpp"
#include "voter_service.hpp"

#include <gtest/gtest.h>
#include <set>

namespace quorient::test {

namespace {

struct Silent final : bus::Writer, bus::Reader {
    bool write(const void*) override { return true; }
    bool take(void*) override { return false; }
    bus::EndpointStatus status() override { return {}; }
};

/// Records the topics of its endpoints.
class NotingBus final : public bus::Bus {
public:
    void wait(std::int64_t) override {}
    Vendor vendor() const override { return Vendor::local; }

    std::set<std::string> written, read;

private:
    std::unique_ptr<bus::Writer> make_writer(const bus::TopicSpec& topic, const bus::WriterOptions&) override
    {
        written.insert(topic.name);
        return std::make_unique<Silent>();
    }
    std::unique_ptr<bus::Reader> make_reader(const bus::TopicSpec& topic, const bus::ReaderOptions&) override
    {
        read.insert(topic.name);
        return std::make_unique<Silent>();
    }
};

class AccessTest : public testing::Test {
protected:
    static system::System load(std::vector<std::string> set)
    {
        system::Overrides overrides;
        overrides.set = std::move(set);
        auto loaded = system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml", overrides);
        if (!loaded) throw std::runtime_error(loaded.error());
        return std::move(*loaded);
    }

    template <class Service, class Settings>
    void expect_exactly(const system::System& system, const Settings& settings)
    {
        NotingBus bus;
        runtime::EventLoop loop{bus, clock_, never_stop_};
        const Service service{in_process(settings), bus, loop};
        compare(system, settings.process.node.name, bus);
    }

    void compare(const system::System& system, const std::string& name, const NotingBus& bus)
    {
        for (const auto& member : system::members_of(system)) {
            if (member.name != name) continue;
            const auto& [publishes, subscribes] = member.access;
            std::set permitted(publishes.begin(), publishes.end());
            if (!bus.written.contains(bus::topics::diagnosis.spec.name)) permitted.erase(bus::topics::diagnosis.spec.name);  // optional
            EXPECT_EQ(bus.written, permitted) << name;
            EXPECT_EQ(bus.read, std::set(subscribes.begin(), subscribes.end())) << name;
            return;
        }
        ADD_FAILURE() << name << " has no identity";
    }

    void expect_exactly_of_sensor(const system::System& system)
    {
        NotingBus bus;
        runtime::EventLoop loop{bus, clock_, never_stop_};
        auto source = sensor::make_source(system.sensor, 1);
        ASSERT_TRUE(source) << source.error();
        const sensor::SensorPublisher service{in_process(system.sensor), std::move(*source), bus, loop};
        compare(system, "sensor", bus);
    }

    runtime::VirtualClock clock_;
    const std::atomic<bool> never_stop_{false};
};

TEST_F(AccessTest, of_every_process_is_what_it_asks_the_bus_for)
{
    const auto system = load({});
    expect_exactly_of_sensor(system);
    for (const auto& lane : system.lanes) {
        expect_exactly<detector::DetectorService>(system, lane.detector);
        expect_exactly<integrator::IntegratorService>(system, lane.integrator);
    }
    for (const auto& voter : system.voters) expect_exactly<voter::VoterService>(system, voter);
}

TEST_F(AccessTest, has_the_topics_of_ros2_where_the_system_file_has_them)
{
    const auto system = load({"ros2={imu: /vessel/imu}", "unit.layout=null",
                              "source={kind: ros2_imu, rate_hz: 100, noise_rad: 1.0e-5, imus: [{topic: /a}, {topic: /b}]}",
                              "lanes=[{name: a, detector: {method: subset}}]"});
    expect_exactly_of_sensor(system);
    for (const auto& voter : system.voters) expect_exactly<voter::VoterService>(system, voter);
    const auto members = system::members_of(system);
    EXPECT_EQ(members.front().access.subscribes.back(), "rt/b");
}

}  // namespace

}  // namespace quorient::test
