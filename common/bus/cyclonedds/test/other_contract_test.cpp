// A plain node of Cyclone DDS that announces a wire contract, beside our bus on either vendor.

#include "../../test/other_contract_scene.hpp"
#include "../src/types.hpp"

#include <dds/dds.h>

namespace quorient::bus {

namespace {

class PlainWriter {
public:
    PlainWriter(std::uint32_t domain, const std::string& announcement)
    {
        auto* node = dds_create_qos();
        dds_qset_entity_name(node, "plain node");
        if (!announcement.empty()) dds_qset_userdata(node, announcement.data(), announcement.size());
        participant_ = dds_create_participant(domain, node, nullptr);
        dds_delete_qos(node);
        const auto& spec = topics::verdict.spec;
        const auto topic = dds_create_topic(participant_, &cyclonedds::descriptor_of(spec.type), spec.name, nullptr, nullptr);
        auto* qos = dds_create_qos();
        dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
        dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
        writer_ = dds_create_writer(participant_, topic, qos, nullptr);
        dds_delete_qos(qos);
    }
    ~PlainWriter() { dds_delete(participant_); }
    PlainWriter(const PlainWriter&) = delete;
    PlainWriter& operator=(const PlainWriter&) = delete;

    void write(const FaultVerdict& verdict) { EXPECT_EQ(dds_write(writer_, &verdict), DDS_RETCODE_OK); }

private:
    dds_entity_t participant_ = 0;
    dds_entity_t writer_ = 0;
};

class OtherContract : public testing::TestWithParam<Vendor> {};

TEST_P(OtherContract, from_a_cyclonedds_node_is_refused_by_name) { expect_refused<PlainWriter>(GetParam()); }

TEST_P(OtherContract, is_not_seen_in_a_cyclonedds_node_of_ours) { expect_accepted<PlainWriter>(GetParam(), contract_announcement()); }

TEST_P(OtherContract, is_not_seen_in_a_cyclonedds_node_that_announces_none) { expect_accepted<PlainWriter>(GetParam(), ""); }

INSTANTIATE_TEST_SUITE_P(Vendors, OtherContract, testing::Values(Vendor::cyclonedds, Vendor::fastdds),
                         [](const auto& vendor) { return std::string{to_string(vendor.param)}; });

}  // namespace

}  // namespace quorient::bus
