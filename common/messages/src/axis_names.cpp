#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"

namespace quorient {
namespace {

std::size_t axes_of_unit(const ClusterDescription& description)
{
    return std::min<std::size_t>(description.axis_count, max_axes);
}

/// The axes of the same instrument.
AxisMask siblings(const ClusterDescription& description, std::size_t axis)
{
    AxisMask axes = 0;
    for (std::size_t other = 0; other < axes_of_unit(description); ++other)
        if (description.instrument[other] == description.instrument[axis]) axes |= axis_bit(other);
    return axes;
}

std::size_t count_of(AxisMask axes)
{
    std::size_t count = 0;
    for (; axes != 0; axes &= axes - 1) ++count;
    return count;
}

/// Empty where the publisher gave none.
std::string_view given_name(const ClusterDescription& description, std::size_t axis)
{
    const std::size_t place = description.instrument[axis];
    return place < max_axes ? text_of(description.instrument_name[place]) : std::string_view{};
}

std::string instrument_name(const ClusterDescription& description, std::size_t axis)
{
    const auto name = given_name(description, axis);
    return name.empty() ? "instrument " + std::to_string(description.instrument[axis]) : std::string{name};
}

std::string single_axis_name(const ClusterDescription& description, std::size_t axis)
{
    const auto name = given_name(description, axis);
    return name.empty() ? "axis " + std::to_string(axis) : std::string{name};
}

/// x, y, z where the instrument has up to three axes; else the place in the instrument.
std::string letter(std::size_t place, std::size_t count)
{
    return count <= 3 ? std::string(1, "xyz"[place]) : std::to_string(place);
}

}  // namespace

std::string axis_name(const ClusterDescription& description, std::size_t axis)
{
    if (axis >= axes_of_unit(description)) return "axis " + std::to_string(axis);
    const AxisMask all = siblings(description, axis);
    const std::size_t count = count_of(all);
    if (count == 1) return single_axis_name(description, axis);
    return instrument_name(description, axis) + " " + letter(count_of(all & (axis_bit(axis) - 1)), count);
}

std::string axis_names(const ClusterDescription& description, AxisMask axes)
{
    if (axes == 0) return "no axis";
    std::string names;
    for (std::size_t axis = 0; axis < 32; ++axis) {
        if (!has_axis(axes, axis)) continue;
        const AxisMask instrument = axis < axes_of_unit(description) ? siblings(description, axis) : axis_bit(axis);
        const bool whole = (axes & instrument) == instrument && count_of(instrument) > 1;
        names += (names.empty() ? "" : ", ") + (whole ? instrument_name(description, axis) : axis_name(description, axis));
        if (whole) axes &= ~instrument;
    }
    return names;
}

std::string axis_numbers(AxisMask axes)
{
    if (axes == 0) return "no axis";
    std::string numbers;
    for (std::size_t axis = 0; axis < 32; ++axis)
        if (has_axis(axes, axis)) numbers += (numbers.empty() ? "" : ", ") + std::to_string(axis);
    return (count_of(axes) == 1 ? "axis " : "axes ") + numbers;
}

}  // namespace quorient
