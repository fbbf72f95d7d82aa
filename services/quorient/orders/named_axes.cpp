#include "named_axes.hpp"

#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>

namespace quorient::cli {

namespace {

std::string without_blanks_around(std::string_view text)
{
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

std::size_t axes_of_unit(const ClusterDescription& description)
{
    return std::min<std::size_t>(description.axis_count, max_axes);
}

std::string_view instrument_of(const ClusterDescription& description, std::size_t axis)
{
    const std::size_t place = description.instrument[axis];
    return place < max_axes ? text_of(description.instrument_name[place]) : std::string_view{};
}

AxisMask axes_called(const std::string& name, const ClusterDescription& description)
{
    AxisMask found = 0;
    for (std::size_t axis = 0; axis < axes_of_unit(description); ++axis)
        if (instrument_of(description, axis) == name || axis_name(description, axis) == name) found |= axis_bit(axis);
    return found;
}

std::string known_names(const ClusterDescription& description)
{
    std::string names = axis_names(description, all_axes(axes_of_unit(description)));
    for (std::size_t axis = 0; axis < axes_of_unit(description); ++axis)
        if (const auto name = axis_name(description, axis); name != instrument_of(description, axis))
            return names + fmt::format("; an axis is '{}'", name);
    return names;
}

}  // namespace

std::vector<std::string> axis_words(std::string_view text)
{
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find_first_of(",+", begin), text.size());
        words.push_back(without_blanks_around(text.substr(begin, end - begin)));
        begin = end + 1;
    }
    return words;
}

bool is_axis_number(std::string_view word)
{
    return !word.empty() && std::ranges::all_of(word, [](char letter) { return letter >= '0' && letter <= '9'; });
}

tl::expected<AxisMask, std::string> named_axes(const std::vector<std::string>& words, const ClusterDescription& description)
{
    AxisMask axes = 0;
    for (const std::string& word : words) {
        if (is_axis_number(word)) {
            std::size_t axis = max_axes;
            std::from_chars(word.data(), word.data() + word.size(), axis);
            if (axis >= max_axes) return tl::unexpected(fmt::format("axis {}: must be 0 to {}", word, max_axes - 1));
            axes |= axis_bit(axis);
            continue;
        }
        const AxisMask named = axes_called(word, description);
        if (named == 0) return tl::unexpected(fmt::format("no axis or instrument is called '{}'; there are {}", word, known_names(description)));
        axes |= named;
    }
    return axes;
}

}  // namespace quorient::cli
