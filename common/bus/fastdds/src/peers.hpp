#pragma once

#include "quorient/bus/refusals.hpp"
#include "quorient/bus/sender.hpp"
#include "version.hpp"

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace quorient::bus::fastdds {

/// The other participants, by the names and the wire contract that they announce. Fast DDS calls it from its own threads.
class Peers final : public ParticipantListener {
public:
    explicit Peers(bool secured) : secured_(secured) {}

    Sender sender(const GuidPrefix& guid) const;
    /// Whether this participant announces another wire contract, so that its samples are not accepted. Without a lock while there is none.
    bool refuses(const GuidPrefix& guid) const;
    std::vector<Refusal> refusals() { return refusals_.take(); }

    /// What an entry of the library's log about a refusal means, with the participant's name where the entry has its GUID.
    std::string in_words(const std::string& entry) const;

private:
    void on_participant(const SeenParticipant& participant) override;
    void onParticipantAuthentication(dds::DomainParticipant*, wire::ParticipantAuthenticationInfo&& info) override;

    bool secured_;
    mutable std::mutex mutex_;
    std::map<GuidPrefix, std::string> names_;
    std::set<GuidPrefix> of_other_contract_;
    std::atomic<bool> refuses_any_ = false;  ///< `of_other_contract_` is not empty
    Refusals refusals_;
};

}  // namespace quorient::bus::fastdds
