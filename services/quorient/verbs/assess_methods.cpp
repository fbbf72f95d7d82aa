#include "assess_methods.hpp"

#include "four_axes/extrapolation_detector.hpp"
#include "single_frame/guaranteed_detector.hpp"
#include "single_frame/invariants_detector.hpp"
#include "single_frame/glt_detector.hpp"
#include "quorient/fdi/methods.hpp"
#include "single_frame/mean_detector.hpp"
#include "single_frame/parity_set_detector.hpp"
#include "single_frame/subset_detector.hpp"
#include "four_axes/vector_detector.hpp"
#include "single_frame/voting_detector.hpp"

#include <algorithm>

namespace quorient::cli {

namespace {

using fdi::Assessment;

constexpr std::size_t shown_scores = 5;

Json interval_json(const fdi::GuaranteedDetector::Interval& interval)
{
    return Json::array({interval.lower, interval.upper});
}

/// Where every set is empty nothing is estimated: nulls in the shape of the figures.
void add_guaranteed_axes(const fdi::GuaranteedDetector& method, const Assessment& assessment, std::size_t axes, Json& row)
{
    Json interval = Json::array();
    Json estimate = Json::array();
    Json half_width = Json::array();
    Json decision = Json::array();
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const auto hull = method.empty() ? fdi::GuaranteedDetector::Interval{NAN, NAN} : method.interval(axis);
        interval.push_back(interval_json(hull));
        estimate.push_back(0.5 * (hull.lower + hull.upper));
        half_width.push_back(method.empty() ? NAN : assessment.bound[axis]);
        decision.push_back(method.empty() ? Json(nullptr) : Json(std::string(1, method.decision(axis))));
        if (method.empty()) row["residual"][axis] = nullptr;
    }
    row["interval"] = std::move(interval);
    row["estimate"] = std::move(estimate);
    row["half_width"] = std::move(half_width);
    row["decision"] = std::move(decision);
}

void add_guaranteed(const fdi::GuaranteedDetector& method, const Assessment& assessment, std::size_t axes,
                    const std::optional<Eigen::Vector3d>& direction, Json& row)
{
    Json sets = Json::array();
    for (std::size_t w = 0; w < method.set_count(); ++w)
        if (method.feasible(w)) sets.push_back(axes_json(method.set(w)));
    if (assessment.outcome == fdi::Outcome::ambiguous) row["candidates"] = sets;
    row["feasible_sets"] = std::move(sets);
    row["empty"] = method.empty();
    add_guaranteed_axes(method, assessment, axes, row);
    if (direction) row["direction_interval"] = interval_json(method.interval_along(*direction));
}

void add_invariants(const fdi::InvariantsDetector& method, Json& row)
{
    row["values"] = method.values();
    Json passed = Json::array();
    for (const std::uint8_t pass : method.passed()) passed.push_back(pass != 0);
    row["passed_count"] = std::count(method.passed().begin(), method.passed().end(), 1);
    row["passed"] = std::move(passed);
}

void add_likelihood_ratio(const fdi::GltDetector& method, std::size_t axes, Json& row)
{
    Json per_axis = Json::array();
    Json parity = Json::array();
    std::size_t best = 0;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        per_axis.push_back(method.explained(axis));
        parity.push_back(method.parity(axis));
        if (method.explained(axis) > method.explained(best)) best = axis;
    }
    row["per_axis"] = std::move(per_axis);
    row["bias_estimate"] = method.parity(best);
    row["parity"] = std::move(parity);
}

void add_subset(const fdi::SubsetDetector& method, Json& row)
{
    Json scores = Json::array();
    for (const auto& score : method.best().first(std::min(shown_scores, method.best().size())))
        scores.push_back({{"axes", axes_json(score.axes)}, {"score", score.statistic}});
    row["scores"] = std::move(scores);
}

void add_extrapolation(const fdi::ExtrapolationDetector& method, Json& row)
{
    const fdi::ModulusPrediction* prediction = method.prediction();
    row["predicted"] = prediction ? Json(prediction->predicted) : Json(nullptr);
    row["triad_modulus"] = method.triad_modulus();
    row["working_triad"] = prediction ? axes_json(method.triad(method.working_triad()).mask()) : Json(nullptr);
    row["z1"] = prediction ? Json(prediction->z1) : Json(nullptr);
    row["z2"] = prediction ? Json(prediction->z2) : Json(nullptr);
    row["determinant"] = prediction ? Json(prediction->determinant) : Json(nullptr);
    row["fallback"] = prediction ? Json(std::string(fdi::name(prediction->fallback))) : Json(nullptr);
}

void add_vector(const fdi::VectorDetector& method, Json& row)
{
    const fdi::VectorDetector::Prediction* prediction = method.prediction();
    row["predicted"] = prediction ? vector_json(prediction->body) : Json(nullptr);
    row["triad_distance"] = prediction ? Json(method.triad_distance()) : Json(nullptr);
    row["working_triad"] = prediction ? axes_json(method.triad(method.working_triad()).mask()) : Json(nullptr);
    row["order"] = prediction ? Json(prediction->order) : Json(nullptr);
}

template <class Method>
const Method& as(const fdi::Detector& detector)
{
    return dynamic_cast<const Method&>(detector);
}

}  // namespace

const std::vector<AssessMethod>& assess_methods()
{
    static const std::vector<AssessMethod> methods{
        {"guaranteed",
         {"--bound", "--threshold", "--max-faults", "--direction"},
         "feasible_sets, empty, interval, estimate, half_width, decision, direction_interval"},
        {"invariants", {"--tolerance", "--relaxed", "--max-faults"}, "values, passed, passed_count"},
        {"voting", {"--tolerance", "--max-faults"}, "passed_count"},
        {"mean", {"--tolerance", "--max-faults"}, ""},
        {"glt", {"--sigma", "--pfa", "--margin"}, "per_axis, bias_estimate, parity"},
        {"parity-set", {"--sigma", "--pfa", "--margin"}, "parity"},
        {"subset", {"--sigma", "--pfa", "--max-faults", "--margin", "--doubt", "--instruments"}, "scores"},
        {"extrapolation", {"--tolerance"}, "predicted, triad_modulus, working_triad, z1, z2, determinant, fallback"},
        {"vector", {"--tolerance"}, "predicted, triad_distance, working_triad, order"},
    };
    return methods;
}

tl::expected<Assessor, std::string> make_assessor(const fdi::DetectorSettings& settings, const geometry::SensorCluster& cluster,
                                                  const std::optional<Eigen::Vector3d>& direction)
{
    auto made = fdi::make_detector(settings, cluster);
    if (!made) return tl::unexpected(made.error());
    const fdi::Detector& detector = **made;
    const std::size_t axes = cluster.size();
    Assessor assessor{std::move(*made), [](const Assessment&, Json&) {}};
    if (settings.method == "guaranteed")
        assessor.add_fields = [&method = as<fdi::GuaranteedDetector>(detector), axes, direction](const Assessment& assessment, Json& row) {
            add_guaranteed(method, assessment, axes, direction, row);
        };
    else if (settings.method == "invariants")
        assessor.add_fields = [&method = as<fdi::InvariantsDetector>(detector)](const Assessment&, Json& row) { add_invariants(method, row); };
    else if (settings.method == "voting")
        assessor.add_fields = [&method = as<fdi::VotingDetector>(detector)](const Assessment&, Json& row) {
            row["passed_count"] = method.passed_count();
        };
    else if (settings.method == "glt")
        assessor.add_fields = [&method = as<fdi::GltDetector>(detector), axes](const Assessment&, Json& row) {
            add_likelihood_ratio(method, axes, row);
        };
    else if (settings.method == "parity-set")
        assessor.add_fields = [&method = as<fdi::ParitySetDetector>(detector)](const Assessment&, Json& row) {
            row["parity"] = vector_json(method.parity());
        };
    else if (settings.method == "subset")
        assessor.add_fields = [&method = as<fdi::SubsetDetector>(detector)](const Assessment&, Json& row) { add_subset(method, row); };
    else if (settings.method == "extrapolation")
        assessor.add_fields = [&method = as<fdi::ExtrapolationDetector>(detector)](const Assessment&, Json& row) {
            add_extrapolation(method, row);
        };
    else if (settings.method == "vector")
        assessor.add_fields = [&method = as<fdi::VectorDetector>(detector)](const Assessment&, Json& row) { add_vector(method, row); };
    return assessor;
}

}  // namespace quorient::cli
