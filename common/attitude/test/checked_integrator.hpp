#pragma once

#include "scenario.hpp"

#include <gtest/gtest.h>
#include <utility>

namespace quorient::attitude::testing {

/// An integrator whose parts must agree with each other after every call.
class CheckedIntegrator : public Integrator {
public:
    explicit CheckedIntegrator(Integrator&& integrator) : Integrator(std::move(integrator)) { check("make"); }

    static CheckedIntegrator make(const IntegratorSettings& settings, const geometry::SensorCluster& cluster)
    {
        return CheckedIntegrator(Integrator::make(settings, cluster).value());
    }

    void add(const SensorFrame& frame)
    {
        Integrator::add(frame);
        check("add");
    }
    void apply(const FaultVerdict& verdict)
    {
        Integrator::apply(verdict);
        check("apply");
    }
    bool work()
    {
        const bool more = Integrator::work();
        check("work");
        return more;
    }
    AttitudeState publish()
    {
        const AttitudeState state = Integrator::publish();
        check("publish");
        return state;
    }
    Mending on_voted(const VotedAttitude& voted)
    {
        const Mending mending = Integrator::on_voted(voted);
        check("on_voted");
        return mending;
    }
    bool reset(const std::array<double, 4>& attitude, std::uint64_t sequence)
    {
        const bool done = Integrator::reset(attitude, sequence);
        check("reset");
        return done;
    }

private:
    void check(const char* call) const
    {
        if (const char* broken = broken_invariant())
            ADD_FAILURE() << "after " << call << "(): " << broken << ", at frame " << state().sequence;
    }
};

inline CheckedIntegrator integrator_for(const geometry::SensorCluster& cluster, const ClassicConing& motion, double history_s = 1,
                                        bool rollback = true)
{
    return CheckedIntegrator::make(settings_for(motion, history_s, rollback), cluster);
}

}  // namespace quorient::attitude::testing
