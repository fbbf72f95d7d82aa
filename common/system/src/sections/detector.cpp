#include "detector.hpp"

#include "quorient/fdi/methods.hpp"
#include "quorient/fdi/observer_detector.hpp"
#include "quorient/system/plant.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quorient::system {

using namespace configuration;

namespace {

std::vector<std::pair<std::string, std::string>> method_words()
{
    std::vector<std::pair<std::string, std::string>> words;
    for (const auto& entry : fdi::methods()) words.emplace_back(entry.word, entry.word);
    return words;
}

template <class Code>
std::vector<std::pair<std::string, Code>> words_of(std::optional<Code> (*named)(std::string_view))
{
    std::vector<std::pair<std::string, Code>> words;
    for (const auto name : fdi::names_of(Code{})) words.emplace_back(name, *named(name));
    return words;
}

/// `field`: what sound instruments may differ by.
Rows<fdi::DetectorSettings> sensor_rows()
{
    using fdi::DetectorSettings;
    Rows<DetectorSettings> rows = word<DetectorSettings, fdi::SensorClass>(
        {.name = "class", .sentence = "`field`: how good the instruments are, and so what sound ones may differ by."}, "class",
        &DetectorSettings::sensor_class, words_of<fdi::SensorClass>(fdi::sensor_class_named));
    const auto mount = word<DetectorSettings, fdi::Mount>(
        {.name = "mount", .sentence = "`field`: on one `board` all see the same motion; on a `structure` they see different vibration."},
        "mount", &DetectorSettings::mount, words_of<fdi::Mount>(fdi::mount_named));
    rows.insert(rows.end(), mount.begin(), mount.end());
    return rows;
}

Rows<DetectorSection> verdict_rows()
{
    return all_of(&DetectorSection::verdict, record<fdi::VerdictSettings>(fdi::verdict_record()));
}

Table<DetectorSection> method_table()
{
    const Table<fdi::DetectorSettings> settings{
        "",
        {word<fdi::DetectorSettings, std::string>(
             {.name = "method", .sentence = "How faults are found (common/fdi); `auto` chooses by the axes."}, "method",
             &fdi::DetectorSettings::method, method_words()),
         sensor_rows(), record<fdi::DetectorSettings>(fdi::detector_record())}};
    return {"", {all_of(&DetectorSection::method, settings.rows()), verdict_rows()}};
}

Table<DetectorSection> observer_table()
{
    using fdi::ObserverScheme;
    using fdi::ObserverSettings;
    const Table<ObserverSettings> settings{
        "",
        {word<ObserverSettings, ObserverScheme>(
             {.name = "scheme",
              .sentence =
                  "`blind`: each observer ignores a channel; `directional`: each one's error moves in a direction of its own (paper 001)."},
             "scheme", &ObserverSettings::scheme,
             {{std::string{fdi::to_string(ObserverScheme::directional)}, ObserverScheme::directional},
              {std::string{fdi::to_string(ObserverScheme::blind)}, ObserverScheme::blind}}),
         required(poles(
             {.name = "poles", .sentence = "Poles of the observers [1/s]; for `directional`, the first of each list is along the fault."},
             &ObserverSettings::poles)),
         value({.name = "sigma",
                .bounds = fdi::sigma_bounds,
                .otherwise = "the source's `noise`",
                .sentence = "Standard deviation of one sample of each channel, or one for all."},
               &ObserverSettings::sigma),
         record<ObserverSettings>(fdi::observer_record())}};
    return {"",
            {refused<DetectorSection>(
                 {"method"},
                 [](const DetectorSection&) { return "a vessel's detectors are observers; choose by scheme: directional or blind"; }),
             all_of(&DetectorSection::observers, settings.rows()),
             value({.name = "margin",
                    .bounds = fdi::observer_margin_bounds,
                    .sentence = "`directional`: channels whose metric is within this factor of the largest are candidates too."},
                   &DetectorSection::observer_margin),
             verdict_rows()}};
}

bool has_model(const DetectorSection& detector)
{
    return unit_kind(detector.unit_kind).has_model;
}

}  // namespace

const Table<DetectorSection>& detector_table()
{
    static const Table<DetectorSection> table{
        "How a lane finds faults.",
        {},
        {{"unit.kind: vessel_rates", "Observers of the unit's plant.", has_model, observer_table().rows()},
         {"unit.kind: gyro or accelerometer", "A method on the unit's axes.",
          [](const DetectorSection& detector) { return !has_model(detector); }, method_table().rows()}}};
    return table;
}

}  // namespace quorient::system
