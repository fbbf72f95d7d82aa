#pragma once

#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/truth_state.hpp"

#include <ostream>

namespace quorient::recording {

/// Writes frames as plain CSV: time, increment_0 …, and where truth is known truth_w, truth_x, truth_y, truth_z. 17 significant digits,
/// so that what is read back is bit-identical. An axis that is not valid is written as nan.
class CsvWriter {
public:
    CsvWriter(std::ostream& out, std::size_t axis_count, bool with_truth);

    /// @param truth  needed exactly if the writer was made with truth.
    void write(const SensorFrame& frame, const TruthState* truth);

private:
    std::ostream& out_;
    std::size_t axis_count_;
    bool with_truth_;
};

}  // namespace quorient::recording
