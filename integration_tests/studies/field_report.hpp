#pragma once

#include "field_trial.hpp"
#include "study.hpp"

#include "quorient/fdi/sensor_class.hpp"
#include "quorient/messages/cluster_description.hpp"

#include <string>
#include <vector>

namespace quorient::studies {

struct LogFigures {
    std::string name;
    std::size_t instruments = 0;
    double duration_s = 0;
    ClusterDescription description;
    SoundRun run;
};

struct FaultFigures {
    FieldFault fault;
    std::vector<FaultRun> runs;
};

/// Everything that the study `field` measured.
struct FieldFigures {
    fdi::Mount mount = fdi::Mount::board;
    std::vector<LogFigures> sound;
    std::vector<LogFigures> faulty;
    std::vector<FaultFigures> faults;
};

Report field_report(const FieldFigures& figures);

}  // namespace quorient::studies
