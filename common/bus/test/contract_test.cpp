#include "quorient/bus/contract.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace quorient::bus {

namespace {

std::vector<std::uint8_t> octets(std::string_view text) { return {text.begin(), text.end()}; }

TEST(WireContract, is_read_back_from_its_announcement)
{
    EXPECT_EQ(announced_contract(octets(contract_announcement())), wire_contract);
    EXPECT_EQ(announced_contract(octets(contract_announcement(4'000'000'000))), 4'000'000'000);
}

TEST(WireContract, of_a_node_that_announces_none_or_something_else_is_unknown_and_accepted)
{
    for (const auto* text : {"", "quorient", "quorient contract=", "quorient contract=-1", "quorient contract=2x", "enclave=/;"}) {
        EXPECT_FALSE(announced_contract(octets(text))) << text;
        EXPECT_FALSE(other_contract(octets(text))) << text;
    }
}

TEST(WireContract, with_another_number_is_refused_in_both_directions)
{
    EXPECT_FALSE(other_contract(octets(contract_announcement())));
    EXPECT_EQ(other_contract(octets(contract_announcement(wire_contract + 1))), wire_contract + 1);
    EXPECT_EQ(other_contract(octets(contract_announcement(wire_contract - 1))), wire_contract - 1);
}

}  // namespace

}  // namespace quorient::bus
