#include "lanes.hpp"

#include "process.hpp"

#include <fmt/format.h>

namespace quorient::system {

using namespace configuration;

namespace {

const Table<IntegratorSection>& integrator_table()
{
    using attitude::IntegratorSettings;
    static const Table<IntegratorSettings> settings{
        "",
        {value({.name = "algorithm", .sentence = "How increments become an attitude: an algorithm of `quorient propagate`."},
               &IntegratorSettings::algorithm),
         record<IntegratorSettings>(attitude::integrator_record())}};
    static const Table<IntegratorSection> table{
        "How a lane integrates.",
        {all_of(&IntegratorSection::integration, settings.rows()), value({.name = "patience",
                                                                          .unit = "intervals",
                                                                          .bounds = settings::Bounds{.lowest = 0, .highest = 1},
                                                                          .sentence = "How long a frame waits for its verdict."},
                                                                         &IntegratorSection::patience)}};
    return table;
}

bool is_integrated(const LaneSection& lane)
{
    return unit_kind(lane.unit_kind).gives_attitude;
}

}  // namespace

const Table<LaneSection>& lane_table()
{
    static const Table<LaneSection> table{
        "A lane: a detector (process `fdi-<name>`) and an integrator (process `attitude-<name>`) that act on its verdicts.",
        {required(value({.name = "name", .sentence = "Name of the lane, up to 22 characters."}, &LaneSection::name)),
         inherited(all_of(&LaneSection::process, process_rows())),
         part<LaneSection, DetectorSection>(
             {.name = "detector", .sentence = "How it finds faults."}, &LaneSection::detector, detector_table(),
             [](const LaneSection& lane, DetectorSection& detector) { detector.unit_kind = lane.unit_kind; })},
        {{"unit.kind: gyro", "", is_integrated,
          part({.name = "integrator", .sentence = "How it integrates."}, &LaneSection::integrator, integrator_table())},
         {"another unit.kind", "No integrator.", [](const LaneSection& lane) { return !is_integrated(lane); },
          refused<LaneSection>({"integrator"}, [](const LaneSection& lane) {
              return fmt::format("{} give no attitude: there is nothing to integrate", unit_kind(lane.unit_kind).subject);
          })}}};
    return table;
}

const Table<VoterSection>& voter_table()
{
    static const Table<VoterSection> table{
        "A voter.",
        {value({.name = "name", .otherwise = "voter-1, voter-2, …", .sentence = "Name of its process, up to 31 characters."},
               &VoterSection::name),
         inherited(all_of(&VoterSection::process, process_rows()))}};
    return table;
}

const Table<SensorSection>& sensor_table()
{
    static const Table<SensorSection> table{
        "The process that publishes frames (`sensor`).",
        {inherited(all_of(&SensorSection::process, process_rows())),
         value({.name = "wait_s",
                .unit = "s",
                .bounds = settings::not_negative,
                .sentence = "How long it waits for all consumers to report READY; then it goes on without them."},
               &SensorSection::wait_s)}};
    return table;
}

}  // namespace quorient::system
