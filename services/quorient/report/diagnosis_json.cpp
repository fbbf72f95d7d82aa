#include "report/diagnosis_json.hpp"

#include <cmath>
#include <optional>

namespace quorient::cli {
namespace {

Json value_of(const std::optional<double>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json list_of(const std::optional<Eigen::Vector3d>& vector)
{
    return vector ? vector_json(*vector) : Json(nullptr);
}

template <class Counts>
std::uint64_t total(const Counts& counts)
{
    std::uint64_t sum = 0;
    for (const auto count : counts) sum += count;
    return sum;
}

Json rotation_json(const std::optional<Eigen::Quaterniond>& rotation)
{
    if (!rotation) return nullptr;
    return Json::array({rotation->w(), rotation->x(), rotation->y(), rotation->z()});
}

/// Least and largest; sensors without a thermometer report 0 all the time.
Json temperature_json(const recording::InstrumentFigures& figures)
{
    const double least = figures.temperature_min_c;
    const double most = figures.temperature_max_c;
    return std::isfinite(least) && (least != 0 || most != 0) ? Json::array({least, most}) : Json(nullptr);
}

Json instrument_json(const diagnosis::InstrumentFacts& facts)
{
    const recording::InstrumentFigures& figures = facts.figures;
    return {{"name", facts.name},
            {"compared", facts.compared},
            {"samples", figures.samples},
            {"rate_hz", figures.rate_hz()},
            {"jitter_s", figures.jitter_s},
            {"coverage", figures.coverage},
            {"gaps", figures.gaps},
            {"longest_gap_s", figures.longest_gap_s},
            {"lost", figures.lost + facts.clock.lost},
            {"duplicates", figures.duplicates},
            {"repeated", figures.repeated},
            {"longest_repeat_s", figures.longest_repeat_s},
            {"steps_back", figures.steps_back},
            {"clipped", figures.clipping_logged ? Json(total(figures.clipped)) : Json(total(figures.at_extreme))},
            {"clock_offset_s", facts.clock.offset_s},
            {"clock_slope", facts.clock.slope},
            {"clock_uncertainty_s", facts.clock.uncertainty_s},
            {"stamps_late_s", facts.clock.own_clock ? Json(facts.clock.late_most_s) : Json(nullptr)},
            {"bias_deg_s", list_of(facts.bias_deg_s)},
            {"bias_from", facts.bias_deg_s ? Json(facts.bias_from_rest ? "rest" : "others") : Json(nullptr)},
            {"gain", list_of(facts.gain)},
            {"rotation", rotation_json(facts.rotation)},
            {"noise_rest_deg_s", list_of(facts.noise_rest_deg_s)},
            {"noise_motion_deg_s", list_of(facts.noise_motion_deg_s)},
            {"temperature_c", temperature_json(figures)}};
}

Json finding_json(const diagnosis::Finding& finding, const diagnosis::Report& report)
{
    Json candidates = Json::array();
    for (const auto candidate : finding.candidates) candidates.push_back(report.instruments[candidate].name);
    return {{"instrument", finding.instrument ? report.instruments[*finding.instrument].name : ""},
            {"axis", finding.axis ? std::string(1, "xyz"[*finding.axis]) : ""},
            {"kind", diagnosis::name_of(finding.kind)},
            {"size", finding.size},
            {"uncertainty", finding.uncertainty},
            {"unit", diagnosis::unit_of(finding.kind)},
            {"bias_deg_s", value_of(finding.bias_deg_s)},
            {"from_s", finding.from_s},
            {"to_s", value_of(finding.to_s)},
            {"certainty", diagnosis::name_of(finding.certainty)},
            {"candidates", std::move(candidates)},
            {"remark", finding.remark}};
}

Json attitude_json(const diagnosis::Report& report)
{
    if (!report.attitude) return nullptr;
    return {{"left_out", report.instruments[report.attitude->left_out].name},
            {"with_deg", report.attitude->with_deg},
            {"alone_deg", report.attitude->alone_deg}};
}

}  // namespace

Json diagnosis_json(const diagnosis::Report& report)
{
    Json json{{"log", report.log}, {"sentence", report.sentence}, {"duration_s", report.duration_s}, {"coverage", report.coverage}};
    json["mount"] = fdi::name_of(report.mount);
    json["instruments"] = Json::array();
    for (const auto& facts : report.instruments) json["instruments"].push_back(instrument_json(facts));
    json["findings"] = Json::array();
    for (const auto& finding : report.findings) json["findings"].push_back(finding_json(finding, report));
    json["peers"] = Json::array();
    for (const auto& peer : report.peers) json["peers"].push_back({{"rule", peer.rule}, {"finding", peer.finding}, {"at_s", value_of(peer.at_s)}});
    json["attitude_difference_deg"] = report.attitude ? Json(report.attitude->with_deg) : Json(nullptr);
    json["attitude"] = attitude_json(report);
    json["rests"] = Json::array();
    for (const auto& rest : report.rests) json["rests"].push_back({{"from_s", rest.from_s}, {"to_s", rest.to_s}});
    json["holes"] = Json::array();
    for (const auto& hole : report.holes) json["holes"].push_back({{"from_s", hole.from_s}, {"to_s", hole.to_s}});
    json["remarks"] = report.remarks;
    return json;
}

}  // namespace quorient::cli
