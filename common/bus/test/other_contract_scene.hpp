#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/bus/contract.hpp"
#include "quorient/bus/topics.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <chrono>
#include <concepts>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace quorient::bus {

inline std::uint32_t contract_test_domain() { return 1 + static_cast<std::uint32_t>(::getpid() % 90); }

/// Our bus reads verdicts beside a plain node that announces something and writes them.
/// @param vendor  of our bus. @tparam PlainWriter  made of the domain and the USER_DATA of its participant; write(FaultVerdict) sends one.
template <class PlainWriter>
class OtherContractScene {
public:
    OtherContractScene(Vendor vendor, const std::string& announcement) : writer_(contract_test_domain(), announcement)
    {
        Settings settings;
        settings.vendor = vendor;
        settings.domain = contract_test_domain();
        settings.participant = "test";
        auto bus = open(settings);
        if (!bus) throw Error(bus.error());
        bus_ = std::move(*bus);
        verdicts_ = std::make_unique<Subscription<FaultVerdict>>(bus_->subscribe(topics::verdict));
    }

    /// Writes, at most for 20 s, until the condition holds.
    bool writes_until(std::predicate auto condition)
    {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
        while (!condition()) {
            if (std::chrono::steady_clock::now() > deadline) return false;
            FaultVerdict verdict;
            verdict.detector = 3;
            verdict.sequence = written_++;
            writer_.write(verdict);
            bus_->wait(2'000'000);
        }
        return true;
    }

    /// Takes all there is; returns whether anything was received yet.
    bool received()
    {
        FaultVerdict verdict;
        while (verdicts_->take(verdict)) {
            EXPECT_EQ(verdict.detector, 3U);
            any_ = true;
        }
        return any_;
    }

    bool refused()
    {
        for (auto& refusal : bus_->refusals()) refusals_.push_back(std::move(refusal));
        return !refusals_.empty();
    }
    const std::vector<Refusal>& refusals() const { return refusals_; }
    bool matched() { return verdicts_->status().matched > 0; }
    std::uint64_t written() const { return written_; }

private:
    PlainWriter writer_;
    std::unique_ptr<Bus> bus_;
    std::unique_ptr<Subscription<FaultVerdict>> verdicts_;
    std::vector<Refusal> refusals_;
    std::uint64_t written_ = 0;
    bool any_ = false;
};

/// A node that announces another contract: nothing of it is received, and the refusal names it.
template <class PlainWriter>
void expect_refused(Vendor vendor)
{
    OtherContractScene<PlainWriter> scene{vendor, contract_announcement(wire_contract + 1)};
    ASSERT_TRUE(scene.writes_until([&] { return scene.received() || scene.refused(); })) << "neither received nor refused within 20 s";
    ASSERT_TRUE(scene.writes_until([&] { return scene.matched(); })) << "never matched: the refusal of samples was not tried";
    const auto enough = scene.written() + 50;
    ASSERT_TRUE(scene.writes_until([&] { return scene.received() || scene.written() > enough; }));
    EXPECT_FALSE(scene.received());
    scene.refused();
    ASSERT_EQ(scene.refusals().size(), 1U);
    EXPECT_EQ(scene.refusals()[0].reason, RefusalReason::other_contract);
    EXPECT_NE(scene.refusals()[0].text.find("'plain node'"), std::string::npos) << scene.refusals()[0].text;
}

/// Its twin, which announces `announcement`: received, and nobody is refused.
template <class PlainWriter>
void expect_accepted(Vendor vendor, const std::string& announcement)
{
    OtherContractScene<PlainWriter> scene{vendor, announcement};
    EXPECT_TRUE(scene.writes_until([&] { return scene.received(); })) << "nothing received within 20 s";
    EXPECT_FALSE(scene.refused());
}

}  // namespace quorient::bus
