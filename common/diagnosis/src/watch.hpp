#pragma once

#include "decimated.hpp"

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace quorient::diagnosis {

/// A stretch in which the detector said the same of the same instruments.
struct Spell {
    enum class What { contradicted, disagreement, saturated };
    What what = What::contradicted;
    AxisMask axes = 0;
    double from_s = 0;
    double to_s = 0;
    double certainty = 0;  ///< the largest
    std::array<fdi::AxisDiagnosis, max_axes> diagnosis{};  ///< the newest of the spell
};

/// What the detector said of an instrument's axes at a time.
struct Snapshot {
    double time_s = 0;
    std::array<fdi::AxisDiagnosis, 3> axis;
};

/// An instrument that the detector named. It is left out from then on; what is wrong with it is looked at until the log's end.
struct Isolation {
    std::size_t instrument = 0;
    double from_s = 0;   ///< the fault
    double named_s = 0;
    Decimated<Snapshot> snapshots{2000};
    Snapshot newest{};
};

/// Plays frames to a detector and notes what it says.
class Watch {
public:
    /// @param left_out  axes that the detector never sees
    Watch(const geometry::SensorCluster& cluster, std::unique_ptr<fdi::Detector> detector, AxisMask left_out = 0);

    /// @param begin_s, end_s  of the frame
    void add(const fdi::Measurement& measurement, double begin_s, double end_s);
    void finish();

    /// Keeps what was said of these axes, and takes the rest from another watch over the same frames.
    void replace_all_but(AxisMask kept, const Watch& other);

    const fdi::Assessment& assessment() const { return assessment_; }  ///< newest frame
    const std::vector<Isolation>& isolations() const { return isolations_; }
    const std::vector<Spell>& spells() const { return spells_; }

private:
    void note_isolations(double time_s);
    Snapshot snapshot_of(std::size_t instrument, double time_s) const;
    void note_spell(Spell::What what, AxisMask axes, std::uint64_t onset, double begin_s, double end_s);
    double begin_of(std::uint64_t sequence) const;
    double fault_begin(double time_s) const;

    geometry::SensorCluster cluster_;
    std::unique_ptr<fdi::Detector> detector_;
    AxisMask named_ = 0;
    fdi::Assessment assessment_;
    std::vector<Isolation> isolations_;
    std::vector<Spell> open_;
    std::vector<Spell> spells_;
    std::vector<double> begins_s_;  ///< ring: of the newest frames, by sequence
    std::uint64_t newest_ = 0;
    std::optional<double> first_s_;
    double last_s_ = 0;
    double last_snapshot_s_ = 0;
};

}  // namespace quorient::diagnosis
