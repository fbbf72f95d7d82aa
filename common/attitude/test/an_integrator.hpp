#pragma once

#include "checked_integrator.hpp"

#include <gtest/gtest.h>

namespace quorient::attitude::testing {

inline constexpr double interval_s = 0.01;
inline const ClassicConing motion(10, 1);

/// An integrator of a cone of six axes that cones.
class AnIntegrator : public ::testing::Test {
protected:
    geometry::SensorCluster cluster = cluster_of("cone-6", interval_s, 1e-6);
    Instrument instrument{cluster, motion};
    CheckedIntegrator integrator = integrator_for(cluster, motion);

    double error() const { return angle_to(integrator.state(), instrument.attitude_after(integrator.state().sequence)); }
};

}  // namespace quorient::attitude::testing
