#include "peers.hpp"

#include "quorient/bus/contract.hpp"
#include "refused_endpoint.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::bus::fastdds {

namespace {

GuidPrefix plain(const wire::GuidPrefix_t& prefix)
{
    GuidPrefix guid{};
    std::copy_n(prefix.value, guid.size(), guid.begin());
    return guid;
}

}  // namespace

void Peers::on_participant(const SeenParticipant& participant)
{
    const auto guid = plain(participant.guid);
    if (secured_ && !participant.gone && participant.unsecured)
        refusals_.add(RefusalReason::security, fmt::format("refuses '{}': it has no certificate", participant.name));
    const auto other = participant.gone ? std::nullopt : other_contract(participant.user_data);
    if (other) refusals_.add(RefusalReason::other_contract, contract_refusal(participant.name, *other));
    const std::lock_guard lock{mutex_};
    if (participant.gone) names_.erase(guid);
    else names_[guid] = participant.name;
    if (other) of_other_contract_.insert(guid);
    else if (!participant.gone) of_other_contract_.erase(guid);  // what it sent before it left may still wait in a reader
    refuses_any_ = !of_other_contract_.empty();
}

void Peers::onParticipantAuthentication(dds::DomainParticipant*, wire::ParticipantAuthenticationInfo&& info)
{
    if (info.status == wire::ParticipantAuthenticationInfo::UNAUTHORIZED_PARTICIPANT)
        refusals_.add(RefusalReason::security,
                      fmt::format("refuses '{}': its certificate is not valid, or not its own", sender(plain(info.guid.guidPrefix)).name));
}

bool Peers::refuses(const GuidPrefix& guid) const
{
    if (!refuses_any_) return false;
    const std::lock_guard lock{mutex_};
    return of_other_contract_.contains(guid);
}

std::string Peers::in_words(const std::string& entry) const
{
    const auto refused = refused_endpoint(entry);
    if (!refused) return "Fast DDS: " + entry;
    const auto member = sender(refused->participant);
    return fmt::format("refuses '{}': it may not {} {}", member.name.empty() ? member.guid : member.name,
                       refused->publishes ? "publish" : "subscribe to", refused->topic);
}

Sender Peers::sender(const GuidPrefix& guid) const
{
    const std::lock_guard lock{mutex_};
    const auto known = names_.find(guid);
    return make_sender(known == names_.end() ? std::string{} : known->second, guid, secured_);
}

}  // namespace quorient::bus::fastdds
