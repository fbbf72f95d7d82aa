#pragma once

#include "quorient/bus/topics.hpp"
#include "quorient/messages/fields.hpp"

#include <array>
#include <cstdint>
#include <random>
#include <type_traits>

namespace quorient::bus {

template <class Value>
void randomise(Value& value, std::mt19937_64& random)
{
    if constexpr (std::is_floating_point_v<Value>) value = std::uniform_real_distribution<Value>{-1e6, 1e6}(random);
    else if constexpr (std::is_same_v<Value, char>) value = static_cast<char>('a' + random() % 26);  // what a DDS char may be
    else value = static_cast<Value>(random());
}

template <class Element, std::size_t Size>
void randomise(std::array<Element, Size>& list, std::mt19937_64& random)
{
    for (auto& element : list) randomise(element, random);
}

inline void randomise(Exclusions& exclusions, std::mt19937_64& random)
{
    for (auto& sequence : exclusions) sequence = random();
}

/// A message whose every member, padding included, is random.
template <class Message>
Message random_message(std::mt19937_64& random)
{
    Message message;
    for_each_field(message, [&](const char*, auto& value) { randomise(value, random); });
    return message;
}

/// The message of a topic that two processes know without an exchange.
template <class Message>
Message message_for(const Topic<Message>& topic, std::uint64_t seed)
{
    std::mt19937_64 random{seed + static_cast<std::uint64_t>(topic.spec.type)};
    return random_message<Message>(random);
}

}  // namespace quorient::bus
