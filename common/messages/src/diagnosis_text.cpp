#include "quorient/messages/diagnosis_text.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/messages/words.hpp"

#include <array>
#include <cstdio>

namespace quorient {
namespace {

/// A unit to read rates in.
struct RateUnit {
    double size;
    const char* name;
};

RateUnit rate_unit_of(const FaultDiagnosis& diagnosis)
{
    if (sensor_kind(diagnosis.kind) == SensorKind::accelerometer) return {1, "m/s^2"};
    return {degree, "deg/s"};
}

/// "gain 0.470 +- 0.010"; without a standard deviation "spikes 40.0 deg/s".
std::string sized(const char* word, double value, double sigma, int decimals, const char* unit)
{
    std::array<char, 96> text{};
    const char* const space = *unit == '\0' ? "" : " ";
    if (sigma > 0) std::snprintf(text.data(), text.size(), "%s %.*f +- %.*f%s%s", word, decimals, value, decimals, sigma, space, unit);
    else std::snprintf(text.data(), text.size(), "%s %.*f%s%s", word, decimals, value, space, unit);
    return text.data();
}

std::string size_text(const FaultDiagnosis& diagnosis, std::size_t axis)
{
    const Diagnosis kind = diagnosis_of(diagnosis, axis);
    const std::string word{to_string(kind)};
    const double size = diagnosis.size[axis];
    const double sigma = diagnosis.sigma[axis];
    const RateUnit rate = rate_unit_of(diagnosis);
    switch (kind) {
        case Diagnosis::bias:
        case Diagnosis::spikes: return sized(word.c_str(), size / rate.size, sigma / rate.size, 2, rate.name);
        case Diagnosis::outside_class: return sized("outside its class by", size / rate.size, sigma / rate.size, 2, rate.name);
        case Diagnosis::gain:
        case Diagnosis::sign: return sized(word.c_str(), size, sigma, 3, "");
        case Diagnosis::delay: return sized(word.c_str(), size * 1e3, sigma * 1e3, 2, "ms");
        case Diagnosis::noise: return sized("noise times", size, 0, 1, "");
        case Diagnosis::mounting: return sized("mounting turned by", size / degree, sigma / degree, 1, "deg");
        default: return word;
    }
}

/// The bias is stated beside these.
bool has_bias_beside(Diagnosis kind)
{
    return kind == Diagnosis::gain || kind == Diagnosis::sign || kind == Diagnosis::mounting || kind == Diagnosis::delay;
}

}  // namespace

std::string diagnosis_text(const FaultDiagnosis& diagnosis, std::size_t axis)
{
    const Diagnosis kind = axis < max_axes ? diagnosis_of(diagnosis, axis) : Diagnosis::none;
    if (kind == Diagnosis::none) return {};
    std::string text = size_text(diagnosis, axis);
    if (!has_bias_beside(kind)) return text;
    const RateUnit rate = rate_unit_of(diagnosis);
    return text + ", " + sized("bias", diagnosis.bias[axis] / rate.size, diagnosis.bias_sigma[axis] / rate.size, 2, rate.name);
}

std::string diagnoses_text(const FaultDiagnosis& diagnosis, const ClusterDescription& description, AxisMask axes)
{
    std::string all;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        const std::string text = has_axis(axes, axis) ? diagnosis_text(diagnosis, axis) : std::string{};
        if (!text.empty()) all += (all.empty() ? "" : "; ") + axis_name(description, axis) + ": " + text;
    }
    return all;
}

}  // namespace quorient
