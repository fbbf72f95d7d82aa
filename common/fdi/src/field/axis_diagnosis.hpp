#pragma once

#include "field/axis_fit.hpp"
#include "field/learning.hpp"
#include "quorient/fdi/detector.hpp"

namespace quorient::fdi::field {

/// What is known beside the fit.
struct DiagnosisContext {
    bool rested = false;     ///< the bias was known
    double usual_noise = 0;  ///< one frame's [rad/s]
    Parameters reference;    ///< standard deviations of what the others may be wrong by
};

/// What the fit itself proves, the most specific explanation first.
/// @param zero  what the measurement is where the axis reads exactly 0 [rad/s]
AxisDiagnosis proved_by(const AxisFit& fit, const Allowed& allowed, double zero, const DiagnosisContext& context);

/// Where the fit proves nothing yet: the rule's own reason, with the size that the fit has for it.
AxisDiagnosis blamed_for(const AxisFit& fit, Diagnosis kind, const DiagnosisContext& context);

}  // namespace quorient::fdi::field
