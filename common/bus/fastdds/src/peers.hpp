#pragma once

#include "quorient/bus/refusals.hpp"
#include "quorient/bus/sender.hpp"
#include "version.hpp"

#include <map>
#include <mutex>
#include <string>

namespace quorient::bus::fastdds {

/// The other participants, by the names that they announce. Fast DDS calls it from its own threads.
class Peers final : public ParticipantListener {
public:
    explicit Peers(bool secured) : secured_(secured) {}

    Sender sender(const GuidPrefix& guid) const;
    std::vector<std::string> refusals() { return refusals_.take(); }

private:
    void on_participant(const SeenParticipant& participant) override;
    void onParticipantAuthentication(dds::DomainParticipant*, wire::ParticipantAuthenticationInfo&& info) override;

    bool secured_;
    mutable std::mutex mutex_;
    std::map<GuidPrefix, std::string> names_;
    Refusals refusals_;
};

}  // namespace quorient::bus::fastdds
