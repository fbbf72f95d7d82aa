#include "writers/sqlite_bag_writer.hpp"
#include "instrument_log_test.hpp"

#include <gmock/gmock.h>

namespace quorient::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class RosBag : public LogFiles {};

TEST_F(RosBag, of_sqlite3_is_read_from_a_file_and_from_memory)
{
    const auto bytes = test::sqlite_bag_of_two_imus(50);
    for (const Samples& log : {samples_of(bytes), samples_of(open_instruments(write("bag.db3", bytes)))}) {
        EXPECT_EQ(log.format, "ROS 2 bag, sqlite3");
        EXPECT_THAT(log.names(), ElementsAre("/imu/left", "/imu/right"));
        EXPECT_TRUE(log.problems.empty());
        ASSERT_EQ(log.of("/imu/left").size(), 50U);
        EXPECT_EQ(log.of("/imu/left")[20].time_ns, 100'200'000'000);
        EXPECT_NEAR(log.of("/imu/left")[20].rate_rad_s[0], 0.2, 1e-15);
        EXPECT_EQ(log.of("/imu/right")[20].rate_rad_s[1], 0.5);
    }
}

TEST_F(RosBag, may_have_its_messages_compressed_one_by_one)
{
    test::SqliteBagWriter bag;
    bag.topic(1, "/imu", "sensor_msgs/msg/Imu");
    const auto message = test::cdr_imu(100, 5, {1, 2, 3});
    test::ByteVector packed(ZSTD_compressBound(message.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), message.data(), message.size(), 3));
    bag.message(1, 1, packed);
    bag.message(1, 2, test::ByteVector(packed.begin(), packed.begin() + 9));
    const Samples log = samples_of(bag.bytes());
    ASSERT_EQ(log.samples.size(), 1U);
    EXPECT_EQ(log.samples[0].time_ns, 100'000'000'005);
    EXPECT_THAT(log.samples[0].rate_rad_s, ElementsAre(1, 2, 3));
    EXPECT_EQ(log.statistics.malformed, 1U);
}

TEST_F(RosBag, says_what_is_wrong_with_a_database)
{
    test::SqliteBagWriter empty;
    empty.topic(1, "/camera", "sensor_msgs/msg/Image");
    EXPECT_THAT(open_instruments(write("none.db3", empty.bytes())).error(), HasSubstr("no topic is a sensor_msgs/msg/Imu"));
    auto bytes = test::sqlite_bag_of_two_imus(500);
    for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 20'000; ++i) bytes[i] = 0xFF;
    const Samples damaged = samples_of(open_instruments(write("damaged.db3", bytes)));
    ASSERT_FALSE(damaged.problems.empty());
    EXPECT_THAT(damaged.problems.back(), AllOf(HasSubstr("damaged.db3"), HasSubstr("message")));
    EXPECT_THAT(open_instruments(write("other.db3", std::string("SQLite format 3\0 and nothing else", 33))).error(), HasSubstr("other.db3"));
}

TEST_F(RosBag, is_a_folder_of_several_files)
{
    write("metadata.yaml", "rosbag2_bagfile_information: {}\n");
    write("bag_1.mcap", test::mcap_of_two_imus(20, "zstd"));
    const auto folder = write("bag_0.mcap", test::mcap_of_two_imus(10, "")).parent_path();
    const Samples log = samples_of(open_instruments(folder));
    EXPECT_THAT(log.names(), ElementsAre("/imu/left", "/imu/right"));
    EXPECT_EQ(log.of("/imu/right").size(), 30U);
    write("c.csv", "t_s,gx_dps,gy_dps,gz_dps\n1,1,2,3\n1.01,1,2,3\n");
    EXPECT_THAT(open_instruments(folder).error(), AllOf(HasSubstr("c.csv"), HasSubstr("none of a bag")));
}

TEST_F(RosBag, is_no_empty_folder)
{
    EXPECT_THAT(open_instruments(write("metadata.yaml", "a: b\n").parent_path()).error(), HasSubstr("without a file"));
}

}  // namespace
}  // namespace quorient::recording
