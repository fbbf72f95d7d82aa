#pragma once

#include <compare>
#include <cstdint>

namespace quorient {

/// Which frame a sample belongs to. Epochs increase with every start of a publisher, sequences count its frames from 0.
/// Frames, verdicts, attitudes and voted attitudes all carry the identity of the frame they belong to.
struct Identity {
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;

    auto operator<=>(const Identity&) const = default;
};

/// The identity a message carries.
template <class Message>
constexpr Identity identity_of(const Message& message)
{
    return {message.epoch, message.sequence};
}

}  // namespace quorient
