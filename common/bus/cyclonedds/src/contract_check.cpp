#include "contract_check.hpp"

#include "quorient/bus/contract.hpp"
#include "sender.hpp"

namespace quorient::bus::cyclonedds {

bool ContractCheck::accepts(dds_instance_handle_t writer)
{
    for (const auto& known : answers_)
        if (known.writer == writer) return known.accepted;
    auto& answer = answers_[next_++ % answers_.size()];
    answer = {writer, ask(writer)};
    return answer.accepted;
}

bool ContractCheck::ask(dds_instance_handle_t writer)
{
    const auto [name, user_data] = announcement_of_writer(reader_, writer);
    if (is_of_our_contract(user_data)) return true;
    refusals_.add(RefusalReason::other_contract, contract_refusal(name, *announced_contract(user_data)));
    return false;
}

}  // namespace quorient::bus::cyclonedds
