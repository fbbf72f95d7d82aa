// A plain node of Fast DDS that announces a wire contract, beside our bus on either vendor.

#include "../../test/other_contract_scene.hpp"
#include "plain_node.hpp"

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <cstring>

namespace quorient::bus {

namespace {

namespace dds = fastdds::dds;

class PlainWriter {
public:
    PlainWriter(std::uint32_t domain, const std::string& announcement) : node_(domain, topics::verdict.spec, announcement)
    {
        dds::DataWriterQos qos;
        qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
        qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
        writer_ = node_.participant().create_publisher(dds::PUBLISHER_QOS_DEFAULT)->create_datawriter(node_.topic(), qos);
    }

    void write(const FaultVerdict& verdict)
    {
        std::memcpy(node_.sample(), &verdict, sizeof verdict);
        EXPECT_TRUE(fastdds::is_ok(writer_->write(node_.sample())));
    }

private:
    fastdds::PlainNode node_;
    dds::DataWriter* writer_ = nullptr;
};

class OtherContract : public testing::TestWithParam<Vendor> {};

TEST_P(OtherContract, from_a_fastdds_node_is_refused_by_name) { expect_refused<PlainWriter>(GetParam()); }

TEST_P(OtherContract, is_not_seen_in_a_fastdds_node_of_ours) { expect_accepted<PlainWriter>(GetParam(), contract_announcement()); }

TEST_P(OtherContract, is_not_seen_in_a_fastdds_node_that_announces_none) { expect_accepted<PlainWriter>(GetParam(), ""); }

INSTANTIATE_TEST_SUITE_P(Vendors, OtherContract, testing::Values(Vendor::cyclonedds, Vendor::fastdds),
                         [](const auto& vendor) { return std::string{to_string(vendor.param)}; });

}  // namespace

}  // namespace quorient::bus
