#include "contract_check.hpp"

#include "quorient/bus/contract.hpp"
#include "sender.hpp"

namespace quorient::bus::cyclonedds {

bool ContractCheck::accepts(dds_instance_handle_t writer)
{
    if (const auto known = accepted_.find(writer); known != accepted_.end()) return known->second;
    return accepted_.emplace(writer, ask(writer)).first->second;
}

bool ContractCheck::ask(dds_instance_handle_t writer)
{
    const auto [name, user_data] = announcement_of_writer(reader_, writer);
    const auto other = other_contract(user_data);
    if (other) refusals_.add(RefusalReason::other_contract, contract_refusal(name, *other));
    return !other;
}

}  // namespace quorient::bus::cyclonedds
