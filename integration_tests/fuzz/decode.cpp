#include "bytes.hpp"
#include "quorient/bus/ros2.hpp"
#include "quorient_msgsPubSubTypes.hpp"
#include "require.hpp"
#include "ros2_msgsPubSubTypes.hpp"
#include "targets.hpp"
#include "tolerant_type.hpp"

#include <memory>

namespace quorient::fuzz {

namespace {

template <class Type>
void decode_as(const std::uint8_t* data, std::size_t size)
{
    using namespace bus::fastdds;
    static dds::TypeSupport type{new TolerantType<Type>};
    const std::unique_ptr<void, void (*)(void*)> sample{type.create_data(), [](void* made) { type.delete_data(made); }};
    wire::SerializedPayload_t payload(static_cast<std::uint32_t>(size));
    std::memcpy(payload.data, data, size);
    payload.length = static_cast<std::uint32_t>(size);
    // What was taken can be written again: the object is whole.
    if (!deserialize(type, payload, sample.get())) return;
    wire::SerializedPayload_t again(serialized_size(type, sample.get()) + 16);
    REQUIRE(serialize(type, sample.get(), again));
}

}  // namespace

void decode(const std::uint8_t* data, std::size_t size)
{
    if (size < 5) return;
    // A sound encapsulation half of the time: else nothing gets past it.
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    if (data[0] % 2 == 0) bytes[0] = 0, bytes[1] = data[0] / 2 % 2, bytes[2] = bytes[3] = 0;
    using namespace quorient_msgs;
    constexpr std::array decoders{decode_as<ClusterDescriptionPubSubType>,
                                  decode_as<SensorFramePubSubType>,
                                  decode_as<TruthStatePubSubType>,
                                  decode_as<FaultVerdictPubSubType>,
                                  decode_as<FaultDiagnosisPubSubType>,
                                  decode_as<AttitudeStatePubSubType>,
                                  decode_as<VoterOutputPubSubType>,
                                  decode_as<VotedAttitudePubSubType>,
                                  decode_as<HealthEventPubSubType>,
                                  decode_as<ServiceStatusPubSubType>,
                                  decode_as<FaultCommandPubSubType>,
                                  decode_as<sensor_msgs::msg::dds_::Imu_PubSubType>,
                                  decode_as<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>};
    for (const auto& decoder : decoders) decoder(bytes.data(), bytes.size());
}

}  // namespace quorient::fuzz
