#include "peers.hpp"

#include "quorient/bus/contract.hpp"
#include "refused_endpoint.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::bus::fastdds {

using eprosima::fastrtps::rtps::GUID_t;
using eprosima::fastrtps::rtps::ParticipantAuthenticationInfo;
using eprosima::fastrtps::rtps::ParticipantDiscoveryInfo;

namespace {

GuidPrefix prefix_of(const GUID_t& whole)
{
    GuidPrefix guid{};
    std::copy_n(whole.guidPrefix.value, guid.size(), guid.begin());
    return guid;
}

}  // namespace

void Peers::on_participant_discovery(eprosima::fastdds::dds::DomainParticipant*, ParticipantDiscoveryInfo&& discovered)
{
    const auto guid = prefix_of(discovered.info.m_guid);
    const std::string name = discovered.info.m_participantName.c_str();
    const bool gone = discovered.status == ParticipantDiscoveryInfo::REMOVED_PARTICIPANT ||
                      discovered.status == ParticipantDiscoveryInfo::DROPPED_PARTICIPANT;
    if (secured_ && !gone && discovered.info.security_attributes_ == 0)
        refusals_.add(RefusalReason::security, fmt::format("refuses '{}': it has no certificate", name));
    const auto contract = announced_contract(discovered.info.m_userData.data_vec());
    const bool other = !gone && contract.value_or(wire_contract) != wire_contract;
    if (other) refusals_.add(RefusalReason::other_contract, contract_refusal(name, *contract));
    const std::lock_guard lock{mutex_};
    if (gone) names_.erase(guid);
    else names_[guid] = name;
    if (other) of_other_contract_.insert(guid);
    else of_other_contract_.erase(guid);
    refuses_any_ = !of_other_contract_.empty();
}

void Peers::onParticipantAuthentication(eprosima::fastdds::dds::DomainParticipant*, ParticipantAuthenticationInfo&& info)
{
    if (info.status == ParticipantAuthenticationInfo::UNAUTHORIZED_PARTICIPANT)
        refusals_.add(RefusalReason::security, fmt::format("refuses '{}': its certificate is not valid, or not its own", sender(prefix_of(info.guid)).name));
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
