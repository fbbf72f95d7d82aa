// What `quorient record` does between DDS and the file.

#include "record/mcap_recording.hpp"
#include "record/schemas.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/fields.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/recording/reader.hpp"
#include "sources.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace quorient::record {
namespace {

using testing::HasSubstr;

constexpr std::int64_t some_time_ns = 1'700'000'000'000'000'000;

SensorFrame frame_of(std::uint64_t sequence)
{
    SensorFrame frame;
    frame.epoch = 1;
    frame.sequence = sequence;
    frame.sample_time_ns = 5'000'000 * static_cast<std::int64_t>(sequence + 1);
    frame.interval_s = 0.005;
    frame.unit = 1;
    frame.kind = octet(SensorKind::gyro);
    frame.axis_count = 4;
    frame.valid_mask = 0b1111;
    frame.increment[0] = static_cast<double>(sequence);
    return frame;
}

class Recording : public testing::Test {
protected:
    Recording() { std::filesystem::create_directories(folder_); }
    ~Recording() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

private:
    std::filesystem::path folder_ = std::filesystem::temp_directory_path() / ("quorient_record_" + std::to_string(::getpid()));
};

std::vector<std::uint64_t> sequences_in(const std::string& file)
{
    auto reader = recording::open_log(file);
    if (!reader) {
        ADD_FAILURE() << reader.error();
        return {};
    }
    std::vector<std::uint64_t> sequences;
    recording::RecordedFrame frame;
    for (auto outcome = (*reader)->next(frame); outcome != recording::ReadOutcome::end; outcome = (*reader)->next(frame)) {
        EXPECT_EQ(outcome, recording::ReadOutcome::frame) << (*reader)->problem();
        sequences.push_back(static_cast<std::uint64_t>(frame.increment[0]));
    }
    return sequences;
}

TEST_F(Recording, has_every_sample_in_its_order)
{
    McapRecording recording(path("all.mcap"), false, {});
    for (std::uint64_t i = 0; i < 5000; ++i) recording.take(bus::topics::frame, frame_of(i), some_time_ns + static_cast<std::int64_t>(i));
    const auto result = recording.finish();
    EXPECT_EQ(result.frames, 5000U);
    EXPECT_EQ(result.dropped, 0U);
    const auto sequences = sequences_in(path("all.mcap"));
    ASSERT_EQ(sequences.size(), 5000U);
    for (std::uint64_t i = 0; i < 5000; ++i) ASSERT_EQ(sequences[i], i);
}

/// Three triads as a calibration describes them.
calibration::CalibratedCluster calibrated_triads()
{
    calibration::CalibratedCluster cluster;
    ClusterDescription& description = cluster.description;
    description.epoch = description.revision = description.unit = 1;
    description.kind = octet(SensorKind::gyro);
    description.interval_s = 0.005;
    description.axis_count = 9;
    description.instrument_count = 3;
    cluster.gain.fill(1);
    for (std::uint8_t axis = 0; axis < 9; ++axis) {
        description.axis[axis][axis % 3] = 1;
        description.instrument[axis] = axis / 3;
        description.sigma[axis] = 1.2345678901234e-5 + 1e-7 * axis;
        description.bias[axis] = 0.01;
        cluster.gain[axis] = 1.02;
    }
    return cluster;
}

/// A recording of these sensors, played with their calibration.
double first_increment_of_a_replay(const std::string& file, const ClusterDescription& recorded)
{
    McapRecording recording(file, false, {});
    recording.take(bus::topics::cluster, recorded, some_time_ns);
    for (std::uint64_t i = 0; i < 100; ++i) {
        SensorFrame frame = frame_of(i);
        frame.axis_count = 9;
        frame.valid_mask = 0x1FF;
        frame.description_revision = 1;
        frame.increment.fill(0.003);
        recording.take(bus::topics::frame, frame, some_time_ns);
    }
    recording.finish();
    system::SensorSettings settings;
    settings.source.log.emplace();
    settings.source.log->files = {file};
    settings.source.log->rest_s = 0;
    settings.source.calibration = calibrated_triads();
    const auto source = sensor::make_source(settings, 1);
    if (!source) throw std::runtime_error(source.error());
    SensorFrame frame;
    TruthState truth;
    EXPECT_EQ((*source)->advance_to(0, frame, truth), sensor::Advance::frame);
    return frame.increment[4];
}

TEST_F(Recording, of_corrected_increments_is_not_corrected_once_more_by_the_same_calibration)
{
    const ClusterDescription corrected = calibrated_triads().description;
    EXPECT_EQ(first_increment_of_a_replay(path("corrected.mcap"), corrected), 0.003);
    ClusterDescription raw = corrected;
    raw.sigma.fill(1e-5);
    EXPECT_NEAR(first_increment_of_a_replay(path("raw.mcap"), raw), (0.003 - 0.01 * 0.005) / 1.02, 1e-15);
}

TEST_F(Recording, drops_and_counts_what_a_file_that_stands_still_leaves_no_room_for_and_does_not_wait)
{
    const auto pipe = path("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    constexpr std::uint64_t count = 200'000;  // more than both buffers of the queue hold
    std::vector<std::uint8_t> bytes;
    McapRecording::Result result;
    {
        McapRecording recording(pipe, false, {});
        for (std::uint64_t i = 0; i < count; ++i) recording.take(bus::topics::frame, frame_of(i), some_time_ns);  // ends only if it never waits
        std::thread reader([&] {
            std::ifstream stream(pipe, std::ios::binary);
            bytes.assign(std::istreambuf_iterator<char>(stream), {});
        });
        result = recording.finish();
        reader.join();
    }
    EXPECT_GT(result.dropped, 0U);
    EXPECT_GT(result.frames, 0U);
    EXPECT_EQ(result.frames + result.dropped, count);
    std::ofstream(path("piped.mcap"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    EXPECT_EQ(sequences_in(path("piped.mcap")).size(), result.frames);
}

TEST_F(Recording, makes_no_file_without_a_sample_and_overwrites_none_without_force)
{
    EXPECT_TRUE(McapRecording(path("none.mcap"), false, {}).finish().files.empty());
    EXPECT_FALSE(std::filesystem::exists(path("none.mcap")));
    std::ofstream(path("taken.mcap")) << "mine";
    std::ofstream(path("turned_0003.mcap")) << "mine";
    EXPECT_THROW(McapRecording(path("taken.mcap"), false, {}), cli::Exit);
    EXPECT_THROW(McapRecording(path("turned.mcap"), false, {.after_mb = 1, .after_s = {}}), cli::Exit);
    EXPECT_NO_THROW(McapRecording(path("turned.mcap"), true, {.after_mb = 1, .after_s = {}}));
}

TEST(RecordSchemas, name_every_member_of_their_own_type_and_no_other_type)
{
    const auto check = [](const auto& topic) {
        using Message = typename std::decay_t<decltype(topic)>::Message;
        const Schema schema = contract_schema(topic.spec.type);
        SCOPED_TRACE(schema.name);
        const Message message;
        for_each_field(message, [&](const char* name, const auto&) { EXPECT_THAT(schema.text, HasSubstr(std::string(" ") + name)); });
        const auto type = schema.name.substr(schema.name.rfind(':') + 1);
        EXPECT_THAT(schema.text, HasSubstr("@final struct " + type + " {"));
        EXPECT_EQ(schema.text.find("struct "), schema.text.rfind("struct ")) << "more than one type";
    };
    std::apply([&](const auto&... topic) { (check(topic), ...); }, bus::topics::all);
}

TEST(ViewerMessages, have_no_transform_while_the_attitude_is_not_known)
{
    ViewerMessages viewers;
    VotedAttitude voted;
    voted.attitude = {0.5, -0.5, 0.5, 0.5};
    voted.level = octet(VoteLevel::full);
    voted.mode = octet(AttitudeMode::normal);
    viewers.make(voted, 1'500'000'007);
    EXPECT_THAT(viewers.transform(), HasSubstr(R"("timestamp":{"sec":1,"nsec":500000007})"));
    EXPECT_THAT(viewers.transform(), HasSubstr(R"("rotation":{"x":-0.5,"y":0.5,"z":0.5,"w":0.5})"));
    voted.mode = octet(AttitudeMode::lost);
    viewers.make(voted, 2'000'000'000);
    EXPECT_TRUE(viewers.transform().empty());
    EXPECT_FALSE(viewers.imu().empty()) << "the rate is still known";
}

}  // namespace
}  // namespace quorient::record
