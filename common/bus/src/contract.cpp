#include "quorient/bus/contract.hpp"

#include <fmt/format.h>
#include <charconv>
#include <string_view>

namespace quorient::bus {

namespace {

constexpr std::string_view prefix = "quorient contract=";

}  // namespace

std::string contract_announcement(std::uint32_t contract)
{
    return fmt::format("{}{}", prefix, contract);
}

std::optional<std::uint32_t> announced_contract(std::span<const std::uint8_t> user_data)
{
    const std::string_view text{reinterpret_cast<const char*>(user_data.data()), user_data.size()};
    if (!text.starts_with(prefix)) return std::nullopt;
    std::uint32_t contract = 0;
    const auto number = text.substr(prefix.size());
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), contract);
    if (error != std::errc{} || end != number.data() + number.size()) return std::nullopt;
    return contract;
}

std::optional<std::uint32_t> other_contract(std::span<const std::uint8_t> user_data)
{
    const auto announced = announced_contract(user_data);
    return announced == wire_contract ? std::nullopt : announced;
}

std::string contract_refusal(const std::string& name, std::uint32_t contract)
{
    return fmt::format("refuses '{}': it has wire contract {}, this process has {}; run the same release of both", name, contract, wire_contract);
}

}  // namespace quorient::bus
