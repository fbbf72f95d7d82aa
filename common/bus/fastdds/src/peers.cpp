#include "peers.hpp"

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
    if (secured_ && !participant.gone && participant.unsecured)
        refusals_.add(fmt::format("refuses '{}': it has no certificate", participant.name));
    const std::lock_guard lock{mutex_};
    if (participant.gone) names_.erase(plain(participant.guid));
    else names_[plain(participant.guid)] = participant.name;
}

void Peers::onParticipantAuthentication(dds::DomainParticipant*, wire::ParticipantAuthenticationInfo&& info)
{
    if (info.status == wire::ParticipantAuthenticationInfo::UNAUTHORIZED_PARTICIPANT)
        refusals_.add(fmt::format("refuses '{}': its certificate is not valid, or not its own", sender(plain(info.guid.guidPrefix)).name));
}

Sender Peers::sender(const GuidPrefix& guid) const
{
    const std::lock_guard lock{mutex_};
    const auto known = names_.find(guid);
    return make_sender(known == names_.end() ? std::string{} : known->second, guid, secured_);
}

}  // namespace quorient::bus::fastdds
