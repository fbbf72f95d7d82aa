#pragma once

#include "quorient/settings/bounds.hpp"

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>

namespace quorient::settings {

/// One setting of a struct: its key in files, what it means, and which values it may have. The only place where this is written: files are
/// read by it, values are checked by it, and the reference page is made of it.
///
/// The default is the member's own initial value.
template <class Settings>
struct Setting {
    using Member = std::variant<bool Settings::*, double Settings::*, std::optional<double> Settings::*, unsigned Settings::*,
                                std::optional<unsigned> Settings::*, std::uint64_t Settings::*>;

    std::string_view key;
    Member member;
    std::string_view unit;  ///< the number's; empty for a bare one
    Bounds bounds;
    std::string_view sentence;     ///< what it does
    std::string_view otherwise{};  ///< what holds where the key is left out, if that is more than the initial value
};

/// The settings of one struct, in the order in which a reader wants them explained.
template <class Settings>
using Record = std::span<const Setting<Settings>>;

/// "patience must be above 0 and at most 10 [intervals], got 0"
std::string out_of_bounds(std::string_view key, const Bounds& bounds, std::string_view unit, double value);

/// @returns the first number that is out of its bounds, as out_of_bounds() words it. What is absent is in order.
template <class Settings>
tl::expected<void, std::string> check(Record<Settings> record, const Settings& values)
{
    for (const auto& setting : record) {
        const auto number = std::visit(
            [&](auto member) {
                const auto& value = values.*member;
                if constexpr (requires { value.has_value(); }) return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
                else return std::optional(static_cast<double>(value));
            },
            setting.member);
        if (number && !setting.bounds.hold(*number))
            return tl::unexpected(out_of_bounds(setting.key, setting.bounds, setting.unit, *number));
    }
    return {};
}

}  // namespace quorient::settings
