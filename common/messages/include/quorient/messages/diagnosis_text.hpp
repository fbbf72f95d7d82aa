#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_diagnosis.hpp"

#include <cstddef>
#include <string>

namespace quorient {

/// What is wrong with an axis, as an operator reads it: "gain 0.470 +- 0.010, bias -10.7 +- 0.1 deg/s". Empty where nothing is known.
std::string diagnosis_text(const FaultDiagnosis& diagnosis, std::size_t axis);

/// All axes of the mask that have a diagnosis: "g0 z: gain 0.470 +- 0.010, bias -10.7 +- 0.1 deg/s; g0 y: ...". Empty where none has one.
std::string diagnoses_text(const FaultDiagnosis& diagnosis, const ClusterDescription& description, AxisMask axes);

}  // namespace quorient
