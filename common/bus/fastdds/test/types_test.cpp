// The generated classes hide their members; their accessors show the members' places.

#include "../src/types.hpp"
#include "../src/version.hpp"
#include "quorient/messages/fields.hpp"
#include "quorient_msgs.hpp"

#include <gtest/gtest.h>
#include <cstddef>
#include <vector>

namespace quorient::bus {

namespace {

/// Places of a plain struct's members, in the order of the wire.
template <class Plain>
std::vector<std::ptrdiff_t> plain_places()
{
    Plain plain;
    std::vector<std::ptrdiff_t> places;
    for_each_field(plain,
                   [&](const char*, auto& value) { places.push_back(reinterpret_cast<char*>(&value) - reinterpret_cast<char*>(&plain)); });
    return places;
}

/// Places of a generated class's members, by its accessors.
template <class Generated, class... Accessor>
std::vector<std::ptrdiff_t> generated_places(Accessor... accessor)
{
    Generated generated;
    return {reinterpret_cast<char*>(&accessor(generated)) - reinterpret_cast<char*>(&generated)...};
}

#define QUORIENT_MEMBER(member)    \
    [](auto& generated) -> auto&   \
    {                              \
        return generated.member(); \
    }

TEST(FastTypes, are_plain_and_bounded)
{
    for (std::size_t type = 0; type < type_count; ++type) {
        const auto support = fastdds::type_support_of(static_cast<TypeId>(type));
        EXPECT_TRUE(fastdds::is_plain(support)) << support.get_type_name();
        EXPECT_TRUE(support.is_bounded()) << support.get_type_name();
    }
}

TEST(FastTypes, have_the_size_of_their_cdr_form)
{
    const std::vector<std::size_t> plain_sizes{
        sizeof(ClusterDescription), sizeof(SensorFrame),   sizeof(TruthState),  sizeof(FaultVerdict),  sizeof(FaultDiagnosis), sizeof(AttitudeState),
        sizeof(VotedAttitude),      sizeof(VotedAttitude), sizeof(HealthEvent), sizeof(ServiceStatus), sizeof(FaultCommand)};
    for (std::size_t type = 0; type < type_count; ++type) {
        auto support = fastdds::type_support_of(static_cast<TypeId>(type));
        void* sample = support.create_data();
        constexpr std::size_t encapsulation = 4;
        EXPECT_EQ(fastdds::serialized_size(support, sample), plain_sizes[type] + encapsulation) << support.get_type_name();
        support.delete_data(sample);
    }
}

/// What recordings rely on: a sample in CDR is known without the vendor's serialiser.
TEST(FastTypes, are_on_the_wire_four_bytes_and_their_memory_image)
{
    for (std::size_t type = 0; type < type_count; ++type) {
        auto support = fastdds::type_support_of(static_cast<TypeId>(type));
        SCOPED_TRACE(support.get_type_name());
        void* sample = support.create_data();
        fastdds::wire::SerializedPayload_t payload(fastdds::serialized_size(support, sample));
        const std::size_t size = payload.max_size - 4;
        auto* const image = static_cast<std::uint8_t*>(sample);
        for (std::size_t i = 0; i < size; ++i) image[i] = static_cast<std::uint8_t>(7 * i + i / 256 + 1);
        ASSERT_TRUE(fastdds::serialize(support, sample, payload));
        ASSERT_EQ(payload.length, size + 4);
        EXPECT_EQ(std::vector<std::uint8_t>(payload.data, payload.data + 4), (std::vector<std::uint8_t>{0, 1, 0, 0})) << "plain CDR, little-endian";
        EXPECT_EQ(std::vector<std::uint8_t>(payload.data + 4, payload.data + payload.length), std::vector<std::uint8_t>(image, image + size));
        support.delete_data(sample);
    }
}

TEST(FastTypes, lie_in_memory_as_the_plain_structs)
{
    EXPECT_EQ(plain_places<ClusterDescription>(),
              generated_places<quorient_msgs::ClusterDescription>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(interval_s), QUORIENT_MEMBER(axis), QUORIENT_MEMBER(position_m),
                  QUORIENT_MEMBER(sigma), QUORIENT_MEMBER(quantum), QUORIENT_MEMBER(range), QUORIENT_MEMBER(bias),
                  QUORIENT_MEMBER(initial_attitude), QUORIENT_MEMBER(unit), QUORIENT_MEMBER(revision), QUORIENT_MEMBER(instrument),
                  QUORIENT_MEMBER(instrument_name), QUORIENT_MEMBER(name), QUORIENT_MEMBER(kind), QUORIENT_MEMBER(axis_count),
                  QUORIENT_MEMBER(instrument_count), QUORIENT_MEMBER(initial_attitude_known), QUORIENT_MEMBER(padding)));
    EXPECT_EQ(plain_places<SensorFrame>(),
              generated_places<quorient_msgs::SensorFrame>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(sample_time_ns), QUORIENT_MEMBER(interval_s),
                  QUORIENT_MEMBER(increment), QUORIENT_MEMBER(accumulated), QUORIENT_MEMBER(known_input), QUORIENT_MEMBER(stamp_ns),
                  QUORIENT_MEMBER(missed), QUORIENT_MEMBER(unit), QUORIENT_MEMBER(valid_mask), QUORIENT_MEMBER(description_revision),
                  QUORIENT_MEMBER(kind), QUORIENT_MEMBER(axis_count), QUORIENT_MEMBER(padding)));
    EXPECT_EQ(plain_places<TruthState>(), generated_places<quorient_msgs::TruthState>(
                                              QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(sample_time_ns),
                                              QUORIENT_MEMBER(attitude), QUORIENT_MEMBER(rate_rad_s), QUORIENT_MEMBER(unit),
                                              QUORIENT_MEMBER(faulty_mask), QUORIENT_MEMBER(attitude_known), QUORIENT_MEMBER(padding)));
    EXPECT_EQ(plain_places<FaultVerdict>(),
              generated_places<quorient_msgs::FaultVerdict>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(sample_time_ns), QUORIENT_MEMBER(excluded_from),
                  QUORIENT_MEMBER(statistic), QUORIENT_MEMBER(threshold), QUORIENT_MEMBER(residual), QUORIENT_MEMBER(bound),
                  QUORIENT_MEMBER(stamp_ns), QUORIENT_MEMBER(unit), QUORIENT_MEMBER(detector), QUORIENT_MEMBER(isolated_mask),
                  QUORIENT_MEMBER(suspect_mask), QUORIENT_MEMBER(candidate_set), QUORIENT_MEMBER(working_mask), QUORIENT_MEMBER(kind),
                  QUORIENT_MEMBER(state), QUORIENT_MEMBER(candidate_count), QUORIENT_MEMBER(candidates_truncated),
                  QUORIENT_MEMBER(detectable_remaining), QUORIENT_MEMBER(adopted), QUORIENT_MEMBER(padding)));
    EXPECT_EQ(plain_places<FaultDiagnosis>(),
              generated_places<quorient_msgs::FaultDiagnosis>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(sample_time_ns), QUORIENT_MEMBER(size),
                  QUORIENT_MEMBER(sigma), QUORIENT_MEMBER(bias), QUORIENT_MEMBER(bias_sigma), QUORIENT_MEMBER(unit),
                  QUORIENT_MEMBER(detector), QUORIENT_MEMBER(provisional_mask), QUORIENT_MEMBER(absent_mask),
                  QUORIENT_MEMBER(degraded_mask), QUORIENT_MEMBER(diagnosis), QUORIENT_MEMBER(kind), QUORIENT_MEMBER(padding)));
    EXPECT_EQ(plain_places<AttitudeState>(),
              generated_places<quorient_msgs::AttitudeState>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(sample_time_ns), QUORIENT_MEMBER(verdict_epoch),
                  QUORIENT_MEMBER(verdict_sequence), QUORIENT_MEMBER(attitude), QUORIENT_MEMBER(reset_rotation),
                  QUORIENT_MEMBER(rate_rad_s), QUORIENT_MEMBER(angle_sigma_rad), QUORIENT_MEMBER(excluded_from), QUORIENT_MEMBER(stamp_ns),
                  QUORIENT_MEMBER(unit), QUORIENT_MEMBER(lane), QUORIENT_MEMBER(used_mask), QUORIENT_MEMBER(isolated_mask),
                  QUORIENT_MEMBER(suspect_mask), QUORIENT_MEMBER(rolled_back_frames), QUORIENT_MEMBER(reset_counter), QUORIENT_MEMBER(mode),
                  QUORIENT_MEMBER(seeded), QUORIENT_MEMBER(bridged), QUORIENT_MEMBER(padding)));
    EXPECT_EQ(plain_places<VotedAttitude>(),
              generated_places<quorient_msgs::VoterOutput>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(sample_time_ns),
                  QUORIENT_MEMBER(output_sequence), QUORIENT_MEMBER(attitude), QUORIENT_MEMBER(reset_rotation), QUORIENT_MEMBER(rate_rad_s),
                  QUORIENT_MEMBER(angle_sigma_rad), QUORIENT_MEMBER(spread_rad), QUORIENT_MEMBER(excluded_from), QUORIENT_MEMBER(stamp_ns),
                  QUORIENT_MEMBER(unit), QUORIENT_MEMBER(voter), QUORIENT_MEMBER(primary_lane), QUORIENT_MEMBER(vouching_mask),
                  QUORIENT_MEMBER(excluded_mask), QUORIENT_MEMBER(used_mask), QUORIENT_MEMBER(isolated_mask), QUORIENT_MEMBER(suspect_mask),
                  QUORIENT_MEMBER(reset_counter), QUORIENT_MEMBER(excluded_why), QUORIENT_MEMBER(mode), QUORIENT_MEMBER(level),
                  QUORIENT_MEMBER(seeded), QUORIENT_MEMBER(bridged)));
    EXPECT_EQ(plain_places<VotedAttitude>(),
              generated_places<quorient_msgs::VotedAttitude>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(sample_time_ns),
                  QUORIENT_MEMBER(output_sequence), QUORIENT_MEMBER(attitude), QUORIENT_MEMBER(reset_rotation), QUORIENT_MEMBER(rate_rad_s),
                  QUORIENT_MEMBER(angle_sigma_rad), QUORIENT_MEMBER(spread_rad), QUORIENT_MEMBER(excluded_from), QUORIENT_MEMBER(stamp_ns),
                  QUORIENT_MEMBER(unit), QUORIENT_MEMBER(voter), QUORIENT_MEMBER(primary_lane), QUORIENT_MEMBER(vouching_mask),
                  QUORIENT_MEMBER(excluded_mask), QUORIENT_MEMBER(used_mask), QUORIENT_MEMBER(isolated_mask), QUORIENT_MEMBER(suspect_mask),
                  QUORIENT_MEMBER(reset_counter), QUORIENT_MEMBER(excluded_why), QUORIENT_MEMBER(mode), QUORIENT_MEMBER(level),
                  QUORIENT_MEMBER(seeded), QUORIENT_MEMBER(bridged)));
    EXPECT_EQ(plain_places<HealthEvent>(),
              generated_places<quorient_msgs::HealthEvent>(
                  QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(wall_time_ns), QUORIENT_MEMBER(event_number),
                  QUORIENT_MEMBER(request), QUORIENT_MEMBER(unit), QUORIENT_MEMBER(source), QUORIENT_MEMBER(axes), QUORIENT_MEMBER(code),
                  QUORIENT_MEMBER(severity), QUORIENT_MEMBER(padding), QUORIENT_MEMBER(source_name), QUORIENT_MEMBER(text)));
    EXPECT_EQ(
        plain_places<ServiceStatus>(),
        generated_places<quorient_msgs::ServiceStatus>(
            QUORIENT_MEMBER(wall_time_ns), QUORIENT_MEMBER(epoch), QUORIENT_MEMBER(sequence_number), QUORIENT_MEMBER(received),
            QUORIENT_MEMBER(published), QUORIENT_MEMBER(gaps), QUORIENT_MEMBER(duplicates), QUORIENT_MEMBER(late), QUORIENT_MEMBER(foreign),
            QUORIENT_MEMBER(rejected), QUORIENT_MEMBER(latency_s), QUORIENT_MEMBER(unit), QUORIENT_MEMBER(service),
            QUORIENT_MEMBER(matched), QUORIENT_MEMBER(process), QUORIENT_MEMBER(role), QUORIENT_MEMBER(state), QUORIENT_MEMBER(vendor),
            QUORIENT_MEMBER(transport), QUORIENT_MEMBER(padding), QUORIENT_MEMBER(name), QUORIENT_MEMBER(version)));
    EXPECT_EQ(plain_places<FaultCommand>(),
              generated_places<quorient_msgs::FaultCommand>(
                  QUORIENT_MEMBER(request), QUORIENT_MEMBER(value), QUORIENT_MEMBER(start_s), QUORIENT_MEMBER(end_s),
                  QUORIENT_MEMBER(frequency_hz), QUORIENT_MEMBER(period_s), QUORIENT_MEMBER(attitude), QUORIENT_MEMBER(unit),
                  QUORIENT_MEMBER(axes), QUORIENT_MEMBER(action), QUORIENT_MEMBER(kind), QUORIENT_MEMBER(padding)));
}

}  // namespace

}  // namespace quorient::bus
