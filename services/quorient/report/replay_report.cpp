#include "replay_report.hpp"

#include "cli/json_output.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/diagnosis_text.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"

namespace quorient::report {

void ReplayReport::on_description(const ClusterDescription& description)
{
    if (!lanes_.empty()) return;
    lanes_.resize(system_.lanes.size());
    description_ = description;
    const auto cluster = geometry::make_cluster(description);
    for (const auto& spec : system_.sensor.source.scenario.faults) {
        const auto resolved = cluster ? simulation::resolve(spec, *cluster) : tl::make_unexpected(cluster.error());
        faults_.push_back({resolved ? *resolved : spec, std::vector<evaluation::Reaction>(system_.lanes.size())});
    }
}

void ReplayReport::on_verdict(const FaultVerdict& verdict)
{
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        if (system_.lanes[lane].detector.detector == verdict.detector) judge(lane, verdict);
    }
}

/// A diagnosis that says nothing any more does not take away what was found before.
void ReplayReport::on_diagnosis(const FaultDiagnosis& diagnosis)
{
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane)
        if (system_.lanes[lane].detector.detector == diagnosis.detector) lanes_[lane].diagnosis = diagnosis;
}

void ReplayReport::judge(std::size_t lane, const FaultVerdict& verdict)
{
    const double time_s = static_cast<double>(verdict.sample_time_ns) * 1e-9;
    AxisMask faulty = 0;
    for (auto& fault : faults_) {
        if (time_s < fault.spec.start_s) continue;
        faulty |= fault.spec.axes;
        fault.lanes[lane].update(verdict, fault.spec.axes, time_s);
    }
    Lane& its = lanes_[lane];
    const AxisMask newly = verdict.isolated_mask & ~its.isolated;
    its.isolated = verdict.isolated_mask;
    // A detector of instruments rightly takes the whole instrument of a faulty axis.
    if (newly != 0) isolations_.push_back({lane, time_s, newly, (newly & faulty) != 0});
}

void ReplayReport::on_voted(const VotedAttitude& voted)
{
    const bool held =
        level_of(voted) == VoteLevel::coasting || level_of(voted) == VoteLevel::lost;
    if (!held) final_attitude_ = voted;
}

nlohmann::ordered_json ReplayReport::faults() const
{
    auto list = nlohmann::ordered_json::array();
    for (const auto& fault : faults_) {
        nlohmann::ordered_json entry = {
            {"spec", simulation::to_string(fault.spec)}, {"axes", cli::axes_json(fault.spec.axes)}, {"begin_s", fault.spec.start_s}};
        for (std::size_t lane = 0; lane < fault.lanes.size(); ++lane) {
            const auto& reaction = fault.lanes[lane];
            entry["lanes"][system_.lanes[lane].name] = {{"detected_s", cli::or_null(reaction.detected_s)},
                                                        {"isolated_s", cli::or_null(reaction.isolated_s)},
                                                        {"isolated", cli::axes_json(reaction.isolated)}};
        }
        list.push_back(std::move(entry));
    }
    return list;
}

nlohmann::ordered_json ReplayReport::false_isolations() const
{
    auto list = nlohmann::ordered_json::array();
    for (const auto& entry : isolations_)
        if (!faults_.empty() && !entry.is_stated)
            list.push_back({{"lane", system_.lanes[entry.lane].name}, {"time_s", entry.time_s}, {"axes", cli::axes_json(entry.axes)}});
    return list;
}

nlohmann::ordered_json ReplayReport::isolations() const
{
    auto list = nlohmann::ordered_json::array();
    for (const auto& entry : isolations_)
        list.push_back({{"lane", system_.lanes[entry.lane].name},
                        {"time_s", entry.time_s},
                        {"axes", cli::axes_json(entry.axes)},
                        {"names", axis_names(description_, entry.axes)},
                        {"diagnosis", diagnoses_text(lanes_[entry.lane].diagnosis, description_, entry.axes)}});
    return list;
}

}  // namespace quorient::report
