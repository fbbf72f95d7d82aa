// A secured system file: every process joins with its own keys, the web monitor with those that fit its rights.

#include "quorient/system/members.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace quorient::system {

namespace {

using testing::HasSubstr;
using testing::StartsWith;

tl::expected<System, std::string> load_demo(std::vector<std::string> set, bool joins = true)
{
    Overrides overrides;
    overrides.set = std::move(set);
    overrides.joins = joins;
    return load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml", overrides);
}

class Identities : public testing::Test {
protected:
    Identities()
    {
        if (!::mkdtemp(directory_.data())) throw std::runtime_error("no temporary directory");
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        const auto now_s = std::chrono::duration_cast<std::chrono::seconds>(now).count();
        const auto system = load_demo({}, false).value();
        auto authority = security::Authority::open_or_make(directory_, now_s).value();
        EXPECT_TRUE(authority.govern(system.monitor.bus.domain, bus::SecurityLevel::encrypt, now_s));
        for (const auto& member : members_of(system)) EXPECT_TRUE(authority.issue(member, now_s, 3600)) << member.name;
    }
    ~Identities() override { std::filesystem::remove_all(directory_); }

    System load_secured(std::vector<std::string> set = {})
    {
        set.push_back("security.directory=" + directory_);
        auto system = load_demo(std::move(set));
        if (!system) throw std::runtime_error(system.error());
        return std::move(*system);
    }

    std::string directory_ = testing::TempDir() + "identities-XXXXXX";
};

TEST_F(Identities, are_those_of_the_processes)
{
    const auto system = load_secured();
    const auto expect = [](const ProcessSettings& process) {
        ASSERT_TRUE(process.bus.security) << process.node.name;
        EXPECT_THAT(process.bus.security->common_name, StartsWith(process.node.name + "."));
        EXPECT_TRUE(bus::suits(process.bus.vendor, process.bus.security->common_name));
        EXPECT_GT(process.node.identity_expires_ns, 0);
    };
    expect(system.sensor.process);
    for (const auto& lane : system.lanes) {
        expect(lane.detector.process);
        expect(lane.integrator.process);
    }
    for (const auto& voter : system.voters) expect(voter.process);
    expect(system.monitor);
}

TEST_F(Identities, of_the_web_monitor_follow_from_what_it_may_do)
{
    const auto looks_on = load_secured({"monitor={}"});
    EXPECT_THAT(looks_on.web_monitor->process.bus.security->common_name, StartsWith("monitor."));
    const auto sends_orders = load_secured({"monitor={allow_orders: true}"});
    EXPECT_THAT(sends_orders.web_monitor->process.bus.security->common_name, StartsWith("operator."));
}

TEST_F(Identities, are_missing_with_their_file)
{
    std::filesystem::remove(directory_ + "/fdi-b/key.pem");
    const auto system = load_demo({"security.directory=" + directory_});
    ASSERT_FALSE(system);
    EXPECT_THAT(system.error(), HasSubstr("fdi-b/key.pem: cannot be read"));
    EXPECT_TRUE(load_demo({"security.directory=" + directory_}, false)) << "nothing joins";
}

}  // namespace

}  // namespace quorient::system
