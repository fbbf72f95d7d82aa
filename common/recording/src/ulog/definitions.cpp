#include "definitions.hpp"

#include "bytes/little_endian.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace quorient::recording::ulog {
namespace {

constexpr int deepest = 8;  // message types within message types
constexpr std::size_t largest_array = 1U << 16U;

struct BasicType {
    std::string_view name;
    NumberType type;
    std::size_t size;
};

constexpr std::array basic_types{
    BasicType{"int8_t", NumberType::int8, 1},       BasicType{"uint8_t", NumberType::uint8, 1},   BasicType{"int16_t", NumberType::int16, 2},
    BasicType{"uint16_t", NumberType::uint16, 2},   BasicType{"int32_t", NumberType::int32, 4},   BasicType{"uint32_t", NumberType::uint32, 4},
    BasicType{"int64_t", NumberType::int64, 8},     BasicType{"uint64_t", NumberType::uint64, 8}, BasicType{"float", NumberType::float32, 4},
    BasicType{"double", NumberType::float64, 8},    BasicType{"bool", NumberType::uint8, 1},      BasicType{"char", NumberType::uint8, 1}};

const BasicType* basic_type(std::string_view name)
{
    const auto* const found = std::find_if(basic_types.begin(), basic_types.end(), [&](const BasicType& type) { return type.name == name; });
    return found == basic_types.end() ? nullptr : &*found;
}

std::size_t size_of_number(NumberType type)
{
    const auto* const found = std::find_if(basic_types.begin(), basic_types.end(), [&](const BasicType& basic) { return basic.type == type; });
    return found == basic_types.end() ? 0 : found->size;
}

/// Cuts off and gives what stands before the mark, or everything.
std::string_view cut(std::string_view& text, char mark)
{
    const std::size_t end = std::min(text.find(mark), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    return part;
}

}  // namespace

std::optional<double> number_at(Bytes message, const Field& field, std::size_t element)
{
    const std::size_t size = size_of_number(field.type);
    const std::size_t at = field.offset + element * size;
    if (element >= field.count || at + size > message.size()) return std::nullopt;
    switch (field.type) {
        case NumberType::int8: return static_cast<std::int8_t>(message[at]);
        case NumberType::uint8: return message[at];
        case NumberType::int16: return little_endian<std::int16_t>(message, at);
        case NumberType::uint16: return little_endian<std::uint16_t>(message, at);
        case NumberType::int32: return little_endian<std::int32_t>(message, at);
        case NumberType::uint32: return little_endian<std::uint32_t>(message, at);
        case NumberType::int64: return static_cast<double>(little_endian<std::int64_t>(message, at));
        case NumberType::uint64: return static_cast<double>(little_endian<std::uint64_t>(message, at));
        case NumberType::float32: return little_endian<float>(message, at);
        case NumberType::float64: return little_endian<double>(message, at);
        case NumberType::none: break;
    }
    return std::nullopt;
}

std::optional<std::uint64_t> integer_at(Bytes message, const Field& field)
{
    constexpr double largest = 9007199254740992.0;  // 2^53: beyond it a double is no identity
    const auto value = number_at(message, field);
    if (!value || field.is_float() || *value < 0 || *value > largest) return std::nullopt;
    return static_cast<std::uint64_t>(*value);
}

bool Definitions::add(std::string_view text)
{
    if (text.find(':') == std::string_view::npos) return false;
    const std::string_view message = cut(text, ':');
    std::vector<Member> members;
    while (!text.empty()) {
        std::string_view name = cut(text, ';');
        std::string_view type = cut(name, ' ');
        if (type.empty() || name.empty()) return false;
        Member member{std::string(cut(type, '[')), std::string(name), 1};
        if (!type.empty()) {
            const auto [end, error] = std::from_chars(type.data(), type.data() + type.size(), member.count);
            if (error != std::errc{} || *end != ']' || member.count > largest_array) return false;
        }
        members.push_back(std::move(member));
    }
    members_.insert_or_assign(std::string(message), std::move(members));
    return true;
}

std::optional<std::size_t> Definitions::size_of(std::string_view type, int depth) const
{
    if (const auto* const basic = basic_type(type)) return basic->size;
    const auto found = members_.find(type);
    if (found == members_.end() || depth == 0) return std::nullopt;
    std::size_t total = 0;
    for (const Member& member : found->second) {
        const auto size = size_of(member.type, depth - 1);
        if (!size || total > largest_array) return std::nullopt;
        total += *size * member.count;
    }
    return total;
}

std::optional<Field> Definitions::field(std::string_view message, std::string_view name) const
{
    const auto found = members_.find(message);
    if (found == members_.end()) return std::nullopt;
    std::size_t offset = 0;
    for (const Member& member : found->second) {
        if (member.name == name) {
            const auto* const basic = basic_type(member.type);
            return basic == nullptr ? std::nullopt : std::optional(Field{offset, basic->type, member.count});
        }
        const auto size = size_of(member.type, deepest);
        if (!size) return std::nullopt;
        offset += *size * member.count;
        if (offset > largest_array) return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace quorient::recording::ulog
