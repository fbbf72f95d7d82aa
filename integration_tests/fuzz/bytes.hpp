#pragma once

#include "quorient/messages/fields.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace quorient::fuzz {

/// Decisions out of a fuzzer's bytes; zeros when they are used up.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

    bool empty() const { return left_ == 0; }

    std::uint8_t byte()
    {
        if (left_ == 0) return 0;
        --left_;
        return *data_++;
    }
    std::uint32_t below(std::uint32_t end) { return (byte() | static_cast<std::uint32_t>(byte()) << 8U) % end; }
    std::uint64_t word()
    {
        std::uint64_t value = 0;
        for (int i = 0; i < 8; ++i) value = value << 8U | byte();
        return value;
    }

private:
    const std::uint8_t* data_;
    std::size_t left_;
};

/// A value that code forgets: the ends of the type's range, what is no number, or any bits at all.
template <class Value>
Value nasty(Bytes& bytes)
{
    const auto choice = bytes.below(10);
    if constexpr (std::is_floating_point_v<Value>) {
        using Limits = std::numeric_limits<Value>;
        const std::array<Value, 8> values{
            0, -0.0, Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), Limits::max(), -1, Limits::denorm_min()};
        if (choice < values.size()) return values[choice];
    } else {
        const std::array<Value, 6> values{Value{},
                                          static_cast<Value>(1),
                                          std::numeric_limits<Value>::max(),
                                          std::numeric_limits<Value>::min(),
                                          static_cast<Value>(std::numeric_limits<Value>::max() - 1),
                                          static_cast<Value>(25)};
        if (choice < values.size()) return values[choice];
    }
    const auto bits = bytes.word();
    Value value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

inline void spoil(Exclusions& exclusions, Bytes& bytes)
{
    exclusions[bytes.below(static_cast<std::uint32_t>(max_axes))] = nasty<std::uint64_t>(bytes);
}

template <class Value>
void spoil(Value& value, Bytes& bytes)
{
    value = nasty<Value>(bytes);
}

template <class Element, std::size_t Size>
void spoil(std::array<Element, Size>& list, Bytes& bytes)
{
    spoil(list[bytes.below(static_cast<std::uint32_t>(Size))], bytes);
}

/// Spoils some members of a message that was right.
template <class Message>
void spoil_members(Message& message, Bytes& bytes)
{
    const auto members = static_cast<std::uint32_t>(std::tuple_size_v<std::decay_t<decltype(Fields<Message>::all)>>);
    for (auto times = bytes.below(3); times > 0; --times) {
        std::uint32_t place = bytes.below(members);
        for_each_field(message, [&](const char*, auto& value) {
            if (place-- == 0) spoil(value, bytes);
        });
    }
}

}  // namespace quorient::fuzz
