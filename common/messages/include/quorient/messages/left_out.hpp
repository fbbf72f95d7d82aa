#pragma once

#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/limits.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <optional>

namespace quorient {

/// Axes that are not used in the message's frame: isolated ones, and those that are left out provisionally.
template <class Message>
constexpr AxisMask left_out_mask(const Message& message)
{
    return message.isolated_mask | message.excluded_from.mask_at(message.sequence);
}

/// The isolated axes with their onsets. Axes that are left out provisionally are not among them: no other process adopts those.
template <class Message>
constexpr Exclusions isolations_of(const Message& message)
{
    return message.excluded_from.of(message.isolated_mask);
}

/// The isolations that a majority of lanes stands behind; nothing where no majority does.
constexpr std::optional<Exclusions> vouched_exclusions(const VotedAttitude& voted)
{
    if (!is_vouched(voted)) return std::nullopt;
    return isolations_of(voted);
}

}  // namespace quorient
