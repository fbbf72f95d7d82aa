#include "quorient/fdi/methods.hpp"

#include "arrays/accumulating_detector.hpp"
#include "field/field_detector.hpp"
#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/redundancy.hpp"
#include "four_axes/extrapolation_detector.hpp"
#include "single_frame/guaranteed_detector.hpp"
#include "single_frame/invariants_detector.hpp"
#include "single_frame/glt_detector.hpp"
#include "single_frame/mean_detector.hpp"
#include "single_frame/parity_set_detector.hpp"
#include "single_frame/subset_detector.hpp"
#include "four_axes/vector_detector.hpp"
#include "single_frame/voting_detector.hpp"
#include "skewed/skewed_detector.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::fdi {

namespace {

using Made = tl::expected<std::unique_ptr<Detector>, std::string>;

template <class Method>
Made made(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    auto detector = Method::make(settings, cluster);
    if (!detector) return tl::unexpected(detector.error());
    return std::unique_ptr<Detector>(std::move(*detector));
}

/// Whether there are two instruments or more, and each measures all three directions.
bool has_instruments(const geometry::SensorCluster& cluster)
{
    std::size_t count = 0;
    for (std::size_t instrument = 0; instrument < cluster.instrument_name.size(); ++instrument) {
        const AxisMask axes = cluster.axes_of(instrument);
        if (axes == 0) continue;
        if (geometry::rank_of(cluster.axes, axes) < 3) return false;
        ++count;
    }
    return count >= 2;
}

Made make_field(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    return has_instruments(cluster) ? made<FieldDetector>(settings, cluster) : made<SkewedDetector>(settings, cluster);
}

/// Single axes whose noise is stated are those of a laboratory: field's allowances would hide what these can show.
bool asks_for_allowances(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    const bool is_asked_more = settings.instruments || settings.margin || settings.max_faults.value_or(1) != 1;
    return !is_asked_more && !has_instruments(cluster) && cluster.interval_s > 0 && !sigma_of_axes(settings, cluster);
}

/// With fewer instruments it could detect and not isolate; two faults at once and their margin are subset's.
bool asks_for_field(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    constexpr std::size_t least_instruments = 3;
    return cluster.instrument_name.size() >= least_instruments && settings.max_faults.value_or(1) == 1 && !settings.margin;
}

Made make_automatic(const DetectorSettings& asked, const geometry::SensorCluster& cluster)
{
    DetectorSettings settings = asked;
    if (cluster.size() == FourAxisDetector::axis_count) return made<VectorDetector>(settings, cluster);
    if (asks_for_field(settings, cluster))
        if (auto detector = made<FieldDetector>(settings, cluster)) return detector;  // else these are no instruments of three directions
    if (asks_for_allowances(settings, cluster) && cluster.size() >= SkewedDetector::least_axes) return made<SkewedDetector>(settings, cluster);
    if (settings.instruments) return made<SubsetDetector>(settings, cluster);
    if (!settings.margin) settings.margin = SubsetDetector::default_margin;
    return made<GltDetector>(settings, cluster);
}

}  // namespace

std::span<const Method> methods()
{
    using enum MethodInput;
    static const std::vector<Method> table{
        {"auto", "4 to 24",
         "vector on four axes; field on three or more triads, and on five or more single axes whose noise nobody states; "
         "else subset where faults take instruments; else glt",
         MethodInput::rows, {}, "", make_automatic},
        {"guaranteed", "max_faults + 4 to 8", "set-membership estimation: never wrong while noise stays within its bound", row,
         {"bound", "threshold", "max-faults", "direction"},
         "feasible_sets, empty, interval, estimate, half_width, decision, direction_interval", made<GuaranteedDetector>},
        {"invariants", "6 to 24", "every four axes' motion-free combination", row, {"tolerance", "relaxed", "bare", "max-faults"},
         "values, passed, passed_count", made<InvariantsDetector>},
        {"voting", "6 to 24", "every three axes' estimate against every other three's", row, {"tolerance", "max-faults"}, "passed_count",
         made<VotingDetector>},
        {"mean", "5 to 24", "the axis farthest from the mean leaves it, repeatedly", row, {"tolerance", "bare", "max-faults"}, "",
         made<MeanDetector>},
        {"glt", "4 to 24", "generalised likelihood ratio test of one axis", row, {"sigma", "pfa", "margin"},
         "per_axis, bias_estimate, parity", made<GltDetector>},
        {"parity-set", "4 to 24", "the same by the minimal set of parity equations", row, {"sigma", "pfa", "margin"}, "parity",
         made<ParitySetDetector>},
        {"subset", "4 to 24", "likelihood of every set of up to max_faults axes or instruments", row,
         {"sigma", "pfa", "max-faults", "margin", "doubt", "instruments"}, "scores", made<SubsetDetector>},
        {"extrapolation", "4", "the triad whose modulus fits the extrapolated one (the paper's method)", rows, {"tolerance"},
         "predicted, triad_modulus, working_triad, z1, z2, determinant, fallback", made<ExtrapolationDetector>},
        {"vector", "4", "the triad whose body vector fits the extrapolated one", rows, {"tolerance"},
         "predicted, triad_distance, working_triad, order", made<VectorDetector>},
        {"field", "5 to 24", "instruments that each span space, or single axes, on any array: allowances by class, noise measured online",
         instruments, {}, "", make_field},
        {"accumulating", "6 to 24", "instruments that each span space, compared over windows of up to 512 frames", instruments, {}, "",
         made<AccumulatingDetector>},
    };
    return table;
}

const Method* find_method(std::string_view word)
{
    const auto found = std::ranges::find(methods(), word, &Method::word);
    return found == methods().end() ? nullptr : &*found;
}

tl::expected<std::unique_ptr<Detector>, std::string> make_detector(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (const Method* method = find_method(settings.method)) return method->make(settings, cluster);
    std::string known;
    for (const Method& method : methods()) known += (known.empty() ? "" : ", ") + std::string(method.word);
    return tl::unexpected(fmt::format("unknown detection method '{}'; known are {}", settings.method, known));
}

}  // namespace quorient::fdi
