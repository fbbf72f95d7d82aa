#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/sensor_frame.hpp"

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// The brain of the detector process: a method, the tests of single axes beside it (AxisHealth: what these find broken the method
/// does not see), and the state machine behind both. One verdict per accepted frame; nothing is allocated per frame.
class FaultMonitor {
public:
    /// @returns why this method cannot serve this cluster, or which setting is wrong.
    static tl::expected<FaultMonitor, std::string> make(const DetectorSettings& detector, const VerdictSettings& verdict,
                                                        const geometry::SensorCluster& cluster);

    /// The same around a detector of one's own.
    static tl::expected<FaultMonitor, std::string> make(std::unique_ptr<Detector> detector, const VerdictSettings& verdict,
                                                        const geometry::SensorCluster& cluster);

    /// The same for channels that are no directions in space (VESSEL_RATES): each may be the last one left, and the detector's own model
    /// decides when one may come back (ObserverReadmission).
    static tl::expected<FaultMonitor, std::string> make(std::unique_ptr<Detector> detector, const VerdictSettings& verdict,
                                                        std::size_t channels);

    FaultMonitor(FaultMonitor&&) noexcept;
    FaultMonitor& operator=(FaultMonitor&&) noexcept;
    ~FaultMonitor();

    /// The verdict of this frame. Frames have passed the intake: in order, finite, of the described cluster. A frame that is not
    /// newer than the last one changes nothing. `detector` and `stamp_ns` are left to the process.
    const FaultVerdict& assess(const SensorFrame& frame);

    /// Takes over the exclusions of a lane that went on while this detector was away, in sequences of the current epoch.
    void adopt(const Exclusions& excluded_from);

    /// @returns those of these axes that are excluded and disagree with the others still (Detector::expectation): a method that keeps watch
    /// on them may be unable to name them again. Others are never listed.
    AxisMask contradicted(AxisMask axes) const;

    /// By command. @returns false where none of the axes was excluded.
    bool readmit(AxisMask axes);

    /// What is wrong with the axes that are isolated, left out, degraded or absent, as of the newest frame. The identity is the newest verdict's;
    /// `detector` is left to the process.
    FaultDiagnosis diagnosis() const;

    const Detector& detector() const { return *detector_; }
    const Assessment& assessment() const { return assessment_; }  ///< the newest frame's

private:
    struct Watch;  // what stands behind the method: fault_monitor.cpp

    FaultMonitor(std::unique_ptr<Detector> detector, std::unique_ptr<Watch> watch, AxisMask all);

    Measurement measurement_of(const SensorFrame& frame) const;
    void after_change(AxisMask before);
    void remember_proofs(AxisMask broken);

    std::unique_ptr<Detector> detector_;
    std::unique_ptr<Watch> watch_;
    AxisMask returning_ = 0;  ///< from the next frame on
    AxisMask all_;
    bool started_ = false;
    Assessment assessment_;
    FaultVerdict verdict_;
};

}  // namespace quorient::fdi
