// A plain node of Fast DDS that announces a wire contract, beside our bus on either vendor.

#include "../../test/other_contract_scene.hpp"
#include "../src/types.hpp"
#include "../src/version.hpp"

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <cstring>

namespace quorient::bus {

namespace {

namespace dds = fastdds::dds;
namespace rtps = fastdds::rtps;

class PlainWriter {
public:
    PlainWriter(std::uint32_t domain, const std::string& announcement) : type_(fastdds::type_support_of(topics::verdict.spec.type))
    {
        dds::DomainParticipantQos node;
        node.name("plain node");
        node.user_data().data_vec().assign(announcement.begin(), announcement.end());
        node.transport().use_builtin_transports = false;
        const auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
        udp->interfaceWhiteList = {"127.0.0.1"};
        node.transport().user_transports.push_back(udp);
        participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(domain, node);
        type_.register_type(participant_);
        auto* topic = participant_->create_topic(topics::verdict.spec.name, type_.get_type_name(), dds::TOPIC_QOS_DEFAULT);
        dds::DataWriterQos qos;
        qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
        qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
        writer_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT)->create_datawriter(topic, qos);
        sample_ = type_.create_data();
    }
    ~PlainWriter()
    {
        type_.delete_data(sample_);
        participant_->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }
    PlainWriter(const PlainWriter&) = delete;
    PlainWriter& operator=(const PlainWriter&) = delete;

    void write(const FaultVerdict& verdict)
    {
        std::memcpy(sample_, &verdict, sizeof verdict);
        EXPECT_TRUE(fastdds::is_ok(writer_->write(sample_)));
    }

private:
    dds::TypeSupport type_;
    dds::DomainParticipant* participant_ = nullptr;
    dds::DataWriter* writer_ = nullptr;
    void* sample_ = nullptr;
};

class OtherContract : public testing::TestWithParam<Vendor> {};

TEST_P(OtherContract, from_a_fastdds_node_is_refused_by_name) { expect_refused<PlainWriter>(GetParam()); }

TEST_P(OtherContract, is_not_seen_in_a_fastdds_node_of_ours) { expect_accepted<PlainWriter>(GetParam(), contract_announcement()); }

TEST_P(OtherContract, is_not_seen_in_a_fastdds_node_that_announces_none) { expect_accepted<PlainWriter>(GetParam(), ""); }

INSTANTIATE_TEST_SUITE_P(Vendors, OtherContract, testing::Values(Vendor::cyclonedds, Vendor::fastdds),
                         [](const auto& vendor) { return std::string{to_string(vendor.param)}; });

}  // namespace

}  // namespace quorient::bus
