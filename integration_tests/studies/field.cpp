// The field detector on any set of logs: as they are, with real faults, and with faults added to the sound ones.

#include "field_report.hpp"
#include "field_runs.hpp"
#include "study.hpp"

namespace quorient::studies {

Report field(const RunSettings& settings, const OnProgress& on_progress)
{
    const std::vector<FieldLog> sound = load_field_logs(settings.logs);
    FieldFigures figures;
    figures.mount = settings.mount;
    figures.sound = play_logs(sound, settings);
    figures.faulty = play_logs(load_field_logs(settings.faulty_logs), settings);
    if (settings.trials > 0) figures.faults = inject_faults(sound, settings, on_progress);
    return field_report(figures);
}

}  // namespace quorient::studies
