#include "quorient/fdi/methods.hpp"

#include "arrays/accumulating_detector.hpp"
#include "four_axes/extrapolation_detector.hpp"
#include "single_frame/guaranteed_detector.hpp"
#include "single_frame/invariants_detector.hpp"
#include "single_frame/glt_detector.hpp"
#include "single_frame/mean_detector.hpp"
#include "single_frame/parity_set_detector.hpp"
#include "single_frame/subset_detector.hpp"
#include "four_axes/vector_detector.hpp"
#include "single_frame/voting_detector.hpp"

#include <fmt/format.h>

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

/// With fewer instruments it could detect and not isolate; two faults at once and their margin are subset's.
bool asks_for_accumulating(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    constexpr std::size_t least_instruments = 3;
    return cluster.instrument_name.size() >= least_instruments && settings.max_faults.value_or(1) == 1 && !settings.margin;
}

Made make_automatic(DetectorSettings settings, const geometry::SensorCluster& cluster)
{
    if (cluster.size() == FourAxisDetector::axis_count) return made<VectorDetector>(settings, cluster);
    if (asks_for_accumulating(settings, cluster))
        if (auto detector = made<AccumulatingDetector>(settings, cluster)) return detector;  // else these are no instruments of three directions
    if (settings.instruments) return made<SubsetDetector>(settings, cluster);
    if (!settings.margin) settings.margin = SubsetDetector::default_margin;
    return made<GltDetector>(settings, cluster);
}

struct Factory {
    std::string_view method;
    Made (*make)(const DetectorSettings&, const geometry::SensorCluster&);
};

constexpr Factory factories[] = {
    {"guaranteed", made<GuaranteedDetector>},   {"invariants", made<InvariantsDetector>},
    {"voting", made<VotingDetector>},           {"mean", made<MeanDetector>},
    {"glt", made<GltDetector>},     {"parity-set", made<ParitySetDetector>},
    {"subset", made<SubsetDetector>}, {"extrapolation", made<ExtrapolationDetector>},
    {"vector", made<VectorDetector>},  {"accumulating", made<AccumulatingDetector>},
};

}  // namespace

const std::vector<MethodEntry>& methods()
{
    static const std::vector<MethodEntry> entries{
        {"auto", "4 to 24",
         "vector on four axes; accumulating on three or more triads; else subset where faults take instruments; else glt"},
        {"guaranteed", "max_faults + 4 to 8", "set-membership estimation: never wrong while noise stays within its bound"},
        {"invariants", "6 to 24", "every four axes' motion-free combination"},
        {"voting", "6 to 24", "every three axes' estimate against every other three's"},
        {"mean", "5 to 24", "the axis farthest from the mean leaves it, repeatedly"},
        {"glt", "4 to 24", "generalised likelihood ratio test of one axis"},
        {"parity-set", "4 to 24", "the same by the minimal set of parity equations"},
        {"subset", "4 to 24", "likelihood of every set of up to max_faults axes or instruments"},
        {"extrapolation", "4", "the triad whose modulus fits the extrapolated one (the paper's method)"},
        {"vector", "4", "the triad whose body vector fits the extrapolated one"},
        {"accumulating", "6 to 24", "instruments that each span space, compared over windows of up to 512 frames"},
    };
    return entries;
}

tl::expected<std::unique_ptr<Detector>, std::string> make_detector(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (settings.method == "auto") return make_automatic(settings, cluster);
    for (const Factory& factory : factories)
        if (factory.method == settings.method) return factory.make(settings, cluster);
    std::string known;
    for (const MethodEntry& entry : methods()) known += (known.empty() ? "" : ", ") + std::string(entry.name);
    return tl::unexpected(fmt::format("unknown detection method '{}'; known are {}", settings.method, known));
}

}  // namespace quorient::fdi
