// What an operator reads when a detector's verdict changes.

#include "verdict_events.hpp"
#include "quorient/bus/local_bus.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/runtime/event_loop.hpp"

#include <gmock/gmock.h>
#include <atomic>
#include <string>
#include <vector>

namespace quorient::detector {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr AxisMask axis_1 = 0b0010;

class Events : public testing::Test {
protected:
    Events()
    {
        loop_.on(reader_->subscribe(bus::topics::event), [this](const HealthEvent& event) { received_.push_back(event); });
        description_.axis_count = 4;
        description_.kind = octet(SensorKind::gyro);
        report(VerdictState::healthy);
        codes();
    }

    static runtime::NodeSettings settings()
    {
        runtime::NodeSettings settings;
        settings.name = "fdi-a";
        settings.heartbeat = false;
        settings.log_events = false;
        return settings;
    }

    /// The next verdict, a second later: throttled events are not held back.
    void report(VerdictState state, AxisMask isolated = 0, AxisMask provisional = 0, const FaultDiagnosis& diagnosis = {})
    {
        clock_.set(clock_.steady_ns() + 1'500'000'000);
        FaultVerdict verdict;
        verdict.epoch = 1;
        verdict.sequence = ++sequence_;
        verdict.state = octet(state);
        verdict.isolated_mask = isolated;
        verdict.excluded_from.exclude(isolated | provisional, 1);
        verdict.detectable_remaining = 1;
        verdict.statistic = 5e-5;
        verdict.threshold = 2e-6;
        verdict.adopted = adopted_ ? 1 : 0;
        events_.report_changes(verdict, description_, "", diagnosis);
        while (loop_.dispatch()) continue;
    }

    /// Codes of the events since this was last asked.
    std::vector<EventCode> codes()
    {
        std::vector<EventCode> codes;
        for (const HealthEvent& event : received_) codes.push_back(code_of(event));
        if (!received_.empty()) text_ = std::string(text_of(received_.back().text));
        received_.clear();
        return codes;
    }

    std::string text_;  ///< that of the last event that codes() has returned
    bool adopted_ = false;  ///< the next verdicts are another detector's

private:
    bus::LocalHub hub_;
    runtime::VirtualClock clock_;
    std::atomic<bool> never_stop_{false};
    std::unique_ptr<bus::Bus> reader_ = hub_.open();
    std::unique_ptr<bus::Bus> bus_ = hub_.open();
    runtime::EventLoop loop_{*reader_, clock_, never_stop_};
    runtime::EventLoop own_loop_{*bus_, clock_, never_stop_};
    runtime::Node node_{settings(), *bus_, own_loop_};
    VerdictEvents events_{node_};
    ClusterDescription description_;
    std::vector<HealthEvent> received_;
    std::uint64_t sequence_ = 0;
};

TEST_F(Events, report_an_axis_that_is_left_out_for_a_time_and_its_return)
{
    report(VerdictState::provisional, 0, axis_1);
    EXPECT_THAT(codes(), ElementsAre(EventCode::left_out));
    EXPECT_THAT(text_, HasSubstr("LEFT OUT"));
    report(VerdictState::provisional, 0, axis_1);
    EXPECT_THAT(codes(), IsEmpty()) << "once";
    report(VerdictState::healthy);
    EXPECT_THAT(codes(), ElementsAre(EventCode::returned));
}

TEST_F(Events, report_a_confirmed_axis_as_isolated_and_not_as_returned)
{
    report(VerdictState::provisional, 0, axis_1);
    codes();
    report(VerdictState::isolated, axis_1);
    EXPECT_THAT(codes(), ElementsAre(EventCode::isolated));
    report(VerdictState::healthy);
    EXPECT_THAT(codes(), ElementsAre(EventCode::readmitted));
}

TEST_F(Events, say_why_an_axis_is_isolated_and_how_clearly_without_a_unit)
{
    report(VerdictState::isolated, axis_1);
    codes();
    EXPECT_THAT(text_, HasSubstr(": disagrees with the others; statistic 25 times its limit"));
    report(VerdictState::healthy);
    FaultDiagnosis diagnosis;
    diagnosis.diagnosis[1] = octet(Diagnosis::absent);
    report(VerdictState::isolated, axis_1, 0, diagnosis);
    codes();
    EXPECT_THAT(text_, HasSubstr(" 1: absent; statistic 25 times its limit"));
}

TEST_F(Events, state_no_statistic_of_an_isolation_that_another_detector_has_made)
{
    adopted_ = true;
    report(VerdictState::isolated, axis_1);
    EXPECT_THAT(codes(), ElementsAre(EventCode::adopted));
    EXPECT_THAT(text_, HasSubstr("ADOPTED"));
    EXPECT_THAT(text_, HasSubstr("another detector has isolated it"));
    EXPECT_THAT(text_, Not(HasSubstr("statistic")));
}

TEST_F(Events, report_saturation_without_naming_an_axis)
{
    report(VerdictState::saturated);
    EXPECT_THAT(codes(), ElementsAre(EventCode::saturated));
    report(VerdictState::saturated);
    EXPECT_THAT(codes(), IsEmpty());
}

TEST_F(Events, report_nothing_while_all_is_well)
{
    report(VerdictState::healthy);
    EXPECT_THAT(codes(), IsEmpty());
}

}  // namespace
}  // namespace quorient::detector
