#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace quorient::bus {

/// Number of the wire contract: the types, topics and codes of idl/. It rises with every change that an older process would misread.
inline constexpr std::uint32_t wire_contract = 1;

/// What a participant of this contract announces in its USER_DATA.
std::string contract_announcement(std::uint32_t contract = wire_contract);

/// @param user_data  of another participant. @returns the contract that it announces; nothing for a node that announces none.
std::optional<std::uint32_t> announced_contract(std::span<const std::uint8_t> user_data);

/// The contract of a participant whose samples are refused for it. @param user_data  of that participant.
/// @returns nothing where its samples are accepted: it announces this contract, or none.
std::optional<std::uint32_t> other_contract(std::span<const std::uint8_t> user_data);

/// The message for an operator. @param name  as the participant announces it.
std::string contract_refusal(const std::string& name, std::uint32_t contract);

}  // namespace quorient::bus
