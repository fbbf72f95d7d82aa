#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/fdi/observer_bank.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/messages/unit_kind.hpp"

namespace quorient::system {

/// `lanes[].detector`: a method on axes, or the observers of a plant, and the verdict behind both.
struct DetectorSection {
    SensorKind unit_kind = SensorKind::gyro;  ///< not a key: unit.kind
    fdi::DetectorSettings method;
    fdi::ObserverSettings observers;  ///< without its plant
    double observer_margin = 1;
    fdi::VerdictSettings verdict;
};

const configuration::Table<DetectorSection>& detector_table();

}  // namespace quorient::system
