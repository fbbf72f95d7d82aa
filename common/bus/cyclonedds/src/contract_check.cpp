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
    if (is_of_our_contract(user_data)) return true;
    refusals_.add(RefusalReason::other_contract, contract_refusal(name, *announced_contract(user_data)));
    return false;
}

}  // namespace quorient::bus::cyclonedds
