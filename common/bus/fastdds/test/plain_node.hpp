#pragma once

#include "../src/types.hpp"
#include "../src/version.hpp"
#include "quorient/bus/topics.hpp"

#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <memory>
#include <string>

namespace quorient::bus::fastdds {

/// A node of the plain vendor on loopback, with one topic and the memory for one sample: nothing of our bus.
class PlainNode {
public:
    /// @param announcement  the USER_DATA of its participant.
    PlainNode(std::uint32_t domain, const TopicSpec& spec, const std::string& announcement = "") : type_(type_support_of(spec.type))
    {
        dds::DomainParticipantQos qos;
        qos.name("plain node");
        qos.user_data().data_vec().assign(announcement.begin(), announcement.end());
        qos.transport().use_builtin_transports = false;
        const auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
        udp->interfaceWhiteList = {"127.0.0.1"};
        qos.transport().user_transports.push_back(udp);
        participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
        type_.register_type(participant_);
        topic_ = participant_->create_topic(spec.name, type_.get_type_name(), dds::TOPIC_QOS_DEFAULT);
        sample_ = type_.create_data();
    }
    ~PlainNode()
    {
        type_.delete_data(sample_);
        participant_->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }
    PlainNode(const PlainNode&) = delete;
    PlainNode& operator=(const PlainNode&) = delete;

    dds::DomainParticipant& participant() { return *participant_; }
    dds::Topic* topic() { return topic_; }
    void* sample() { return sample_; }

private:
    dds::TypeSupport type_;
    dds::DomainParticipant* participant_ = nullptr;
    dds::Topic* topic_ = nullptr;
    void* sample_ = nullptr;
};

}  // namespace quorient::bus::fastdds
