#include "json_output.hpp"

#include <fmt/format.h>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace quorient::cli {

namespace {

/// Whole numbers up to here are exact in readers that have only doubles (JavaScript, jq).
constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53;

bool is_exact_in_doubles(const Json& whole)
{
    if (whole.is_number_unsigned()) return whole.get<std::uint64_t>() <= largest_exact;
    const auto number = whole.get<std::int64_t>();
    return number >= -static_cast<std::int64_t>(largest_exact) && number <= static_cast<std::int64_t>(largest_exact);
}

/// Names come from files of any encoding: bytes that are no UTF-8 are replaced by U+FFFD, since JSON knows nothing else.
std::string plain(const Json& value)
{
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// nlohmann's own dump writes the shortest text that reads back to the same number; the contract asks for 17 digits.
void append(std::string& text, const Json& value)
{
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (std::isfinite(number)) fmt::format_to(std::back_inserter(text), "{:.17g}", number);
        else text += "null";
    } else if (value.is_array()) {
        text += '[';
        for (const Json& element : value) {
            if (text.back() != '[') text += ',';
            append(text, element);
        }
        text += ']';
    } else if (value.is_object()) {
        text += '{';
        for (const auto& [key, member] : value.items()) {
            if (text.back() != '{') text += ',';
            text += plain(key) + ':';
            append(text, member);
        }
        text += '}';
    } else if (value.is_number_integer() && !is_exact_in_doubles(value)) {
        text += '"' + plain(value) + '"';
    } else {
        text += plain(value);
    }
}

}  // namespace

std::string dump(const Json& value)
{
    std::string text;
    append(text, value);
    return text;
}

Json or_null(const std::optional<double>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json axes_json(AxisMask mask)
{
    Json list = Json::array();
    for (std::size_t axis = 0; axis < 32; ++axis)
        if (has_axis(mask, axis)) list.push_back(axis);
    return list;
}

}  // namespace quorient::cli
