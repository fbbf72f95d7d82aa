#include "instrument_log_test.hpp"
#include "writers/ulog_writer.hpp"

#include <gmock/gmock.h>

namespace quorient::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using test::Bytes;
using test::Float3;
using test::UlogWriter;

TEST(Ulog, gives_every_instance_its_own_times_and_rates)
{
    const Samples log = samples_of(test::ulog_of_three_imus(20));
    EXPECT_EQ(log.format, "PX4 ULog");
    EXPECT_THAT(log.names(), ElementsAre("vehicle_imu.0", "vehicle_imu.1", "vehicle_imu.2", "sensor_combined"));
    EXPECT_TRUE(log.problems.empty());
    ASSERT_EQ(log.of("vehicle_imu.2").size(), 20U);
    const InstrumentSample sample = log.of("vehicle_imu.2")[4];
    EXPECT_EQ(sample.time_ns, (2'000'000 + 4 * 5000 + 1400) * 1000LL) << "the time of the sample, not of the message";
    EXPECT_NEAR(sample.rate_rad_s[0], 0.04, 1e-7);
    EXPECT_EQ(sample.covered_s, 0.005);
    EXPECT_NEAR(sample.acceleration_m_s2[2], -9.8, 1e-5);
    EXPECT_EQ(log.instruments[2].device, 202U);
    EXPECT_FALSE(sample.clipped) << "a field that is not there is unknown, not unclipped";
}

/// A vehicle_imu message with a time field of this type.
template <class Time>
Samples with_time(const std::string& type, Time over)
{
    UlogWriter writer;
    writer.format("vehicle_imu:uint64_t timestamp;" + type + " delta_angle_dt;float[3] delta_angle;");
    writer.subscribe(1, 0, "vehicle_imu");
    writer.data(1, std::uint64_t{1'000'000}, over, Float3{0.01F, 0.02F, 0.03F});
    writer.data(1, std::uint64_t{9'000'000}, over, Float3{0.01F, 0.02F, 0.03F});
    return samples_of(writer.log.data);
}

TEST(Ulog, divides_increments_by_their_own_time_whatever_its_type)
{
    for (const Samples& log : {with_time("uint16_t", std::uint16_t{5000}), with_time("uint32_t", std::uint32_t{5000}), with_time("float", 0.005F),
                               with_time("uint64_t", std::uint64_t{5000})}) {
        ASSERT_EQ(log.samples.size(), 2U);
        EXPECT_NEAR(log.samples[1].rate_rad_s[2], 6.0, 1e-5) << "never over the 8 s that are missing";
        EXPECT_NEAR(log.samples[1].covered_s, 0.005, 1e-9);
    }
    const Samples none = with_time("uint16_t", std::uint16_t{0});
    EXPECT_TRUE(none.samples.empty());
    EXPECT_EQ(none.statistics.malformed, 2U);
}

TEST(Ulog, reads_the_gyros_of_old_and_new_firmware)
{
    UlogWriter writer;
    writer.format("sensor_gyro:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float y;float z;float temperature;"
                  "uint32_t error_count;uint8_t[3] clip_counter;uint8_t samples;");
    writer.format("old:uint8_t a;");
    writer.subscribe(1, 1, "sensor_gyro");
    writer.data(1, std::uint64_t{2000}, std::uint64_t{1500}, 77U, 1.0F, 2.0F, 3.0F, 41.5F, 0U, std::array<std::uint8_t, 3>{0, 4, 0},
                std::uint8_t{5});
    const Samples now = samples_of(writer.log.data);
    EXPECT_THAT(now.names(), ElementsAre("sensor_gyro.1"));
    EXPECT_EQ(now.samples[0].time_ns, 1'500'000);
    EXPECT_EQ(now.samples[0].temperature_c, 41.5);
    EXPECT_EQ(now.samples[0].clipped, 0b010);
    EXPECT_EQ(now.instruments[0].device, 77U);

    UlogWriter old;
    old.format("sensor_gyro:uint64_t timestamp;uint32_t device_id;float x;float y;float z;uint32_t integral_dt;"
               "float x_integral;float y_integral;float z_integral;");
    old.subscribe(1, 0, "sensor_gyro");
    old.data(1, std::uint64_t{2000}, 77U, 1.0F, 2.0F, 3.0F, 4000U, 0.02F, 0.0F, -0.04F);
    const Samples then = samples_of(old.log.data);
    EXPECT_NEAR(then.samples[0].rate_rad_s[0], 5.0, 1e-5) << "the integral leaves nothing out, the last sample alone does";
    EXPECT_NEAR(then.samples[0].rate_rad_s[2], -10.0, 1e-5);

    UlogWriter fifo;
    fifo.format("sensor_gyro_fifo:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float dt;float scale;uint8_t samples;"
                "int16_t[4] x;int16_t[4] y;int16_t[4] z;");
    fifo.subscribe(1, 0, "sensor_gyro_fifo");
    using Short4 = std::array<std::int16_t, 4>;
    fifo.data(1, std::uint64_t{2000}, std::uint64_t{1000}, 77U, 125.0F, 0.5F, std::uint8_t{3}, Short4{1, 2, 3, 9}, Short4{}, Short4{});
    const Samples raw = samples_of(fifo.log.data);
    ASSERT_EQ(raw.samples.size(), 3U);
    EXPECT_EQ(raw.samples[0].time_ns, 750'000);
    EXPECT_EQ(raw.samples[2].time_ns, 1'000'000);
    EXPECT_EQ(raw.samples[2].rate_rad_s[0], 1.5);
}

TEST(Ulog, reads_the_selected_imu_of_old_and_new_firmware_and_says_which_it_is)
{
    UlogWriter writer;
    writer.format("sensor_combined:uint64_t timestamp;float[3] gyro_rad;float gyro_integral_dt;uint8_t gyro_clipping;");
    writer.format("sensor_selection:uint64_t timestamp;uint32_t accel_device_id;uint32_t gyro_device_id;");
    writer.subscribe(1, 0, "sensor_combined");
    writer.subscribe(2, 0, "sensor_selection");
    writer.data(2, std::uint64_t{500}, 1U, 201U);
    writer.data(1, std::uint64_t{1000}, Float3{1, 2, 3}, 0.004F, std::uint8_t{0b101});
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.samples.size(), 1U);
    EXPECT_THAT(log.samples[0].rate_rad_s, ElementsAre(1.0, 2.0, 3.0));
    EXPECT_NEAR(log.samples[0].covered_s, 0.004, 1e-9);
    EXPECT_EQ(log.samples[0].clipped, 0b101);
    ASSERT_EQ(log.selections.size(), 1U);
    EXPECT_EQ(log.selections[0].device, 201U);
    EXPECT_EQ(log.selections[0].time_ns, 500'000);
}

TEST(Ulog, steps_over_nested_types_and_padding_that_is_not_logged)
{
    UlogWriter writer;
    writer.format("inner:float[2] a;uint8_t b;uint8_t[3] _padding0;");
    writer.format("sensor_gyro:inner[2] before;uint64_t timestamp;float x;float y;float z;uint8_t[4] _padding0;");
    writer.subscribe(1, 0, "sensor_gyro");
    writer.data(1, std::array<std::uint8_t, 24>{}, std::uint64_t{3000}, 1.0F, 2.0F, 3.0F);
    writer.data(1, std::array<std::uint8_t, 24>{}, std::uint64_t{4000}, 1.0F, 2.0F);
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.samples.size(), 1U);
    EXPECT_EQ(log.samples[0].time_ns, 3'000'000);
    EXPECT_EQ(log.statistics.malformed, 1U) << "the second message ends before z";
}

TEST(Ulog, survives_definitions_that_contain_themselves)
{
    UlogWriter writer;
    writer.format("inner:inner a;");
    writer.format("sensor_gyro:inner before;uint64_t timestamp;float x;float y;float z;");
    writer.subscribe(1, 0, "sensor_gyro");
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.remarks.size(), 1U);
    EXPECT_THAT(log.remarks[0], HasSubstr("sensor_gyro is not read"));
}

TEST(Ulog, goes_on_where_data_was_appended_after_a_crash)
{
    UlogWriter writer;
    writer.flags(1, 0);
    writer.format("sensor_gyro:uint64_t timestamp;float x;float y;float z;");
    writer.subscribe(1, 0, "sensor_gyro");
    writer.data(1, std::uint64_t{3000}, 1.0F, 2.0F, 3.0F);
    writer.data(1, std::uint64_t{4000}, 1.0F, 2.0F, 3.0F);
    auto bytes = writer.log.data;
    bytes.resize(bytes.size() - 7);  // the crash
    const std::uint64_t appended_at = bytes.size();
    std::memcpy(bytes.data() + 16 + 3 + 16, &appended_at, sizeof appended_at);
    UlogWriter more;
    more.data(1, std::uint64_t{5000}, 1.0F, 2.0F, 3.0F);
    bytes.insert(bytes.end(), more.log.data.begin() + 16, more.log.data.end());
    const Samples log = samples_of(bytes);
    ASSERT_EQ(log.samples.size(), 2U);
    EXPECT_EQ(log.samples[1].time_ns, 5'000'000);
    EXPECT_TRUE(log.problems.empty());
    EXPECT_THAT(log.remarks, ElementsAre(HasSubstr("appended")));
}

TEST(Ulog, finds_the_next_synchronisation_behind_damage_and_counts_a_cut_end)
{
    const auto whole = test::ulog_of_three_imus(200);
    auto bytes = whole;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), 300, std::uint8_t{0xFF});
    bytes.resize(bytes.size() - 5);
    const Samples log = samples_of(bytes);
    EXPECT_GE(log.problems.size(), 2U);
    EXPECT_GT(log.statistics.skipped_bytes, 200U);
    EXPECT_GT(log.samples.size(), 4 * (200 - 51) - 1U);
    EXPECT_GT(log.statistics.truncated_bytes, 0U);
    EXPECT_EQ(log.samples.back().time_ns / 1000, 2'000'000 + 199 * 5000 + 1400) << "to the last whole message";
}

TEST(Ulog, says_what_the_logger_lost)
{
    UlogWriter writer;
    writer.dropout(30);
    writer.dropout(12);
    EXPECT_THAT(samples_of(writer.log.data).remarks, ElementsAre(AllOf(HasSubstr("2 dropouts"), HasSubstr("42 ms"))));
}

TEST(Ulog, refuses_logs_that_need_a_newer_reader)
{
    UlogWriter writer;
    writer.flags(2, 0);
    EXPECT_THAT(refusal_of(std::string(writer.log.data.begin(), writer.log.data.end())), HasSubstr("newer reader"));
}

TEST(Ulog, finds_in_a_real_log_what_an_independent_program_counts)
{
    const auto file = field_dir() / "px4_3_imus.ulg";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no log " << file;
    const Samples log = samples_of(open_instruments(file));
    EXPECT_TRUE(log.problems.empty());
    EXPECT_EQ(log.of("sensor_combined").size(), 1298U);
    for (const char* const name : {"vehicle_imu.0", "vehicle_imu.1", "vehicle_imu.2"}) EXPECT_EQ(log.of(name).size(), 12U);
    for (const char* const name : {"sensor_gyro.0", "sensor_gyro.1", "sensor_gyro.2"}) EXPECT_EQ(log.of(name).size(), 6U);
    const auto second = log.of("vehicle_imu.1")[0];
    EXPECT_EQ(second.time_ns, 20'828'270'000);
    EXPECT_NEAR(second.covered_s, 4973e-6, 1e-12);
    EXPECT_NEAR(second.rate_rad_s[0], 4.996974e-6 / 4973e-6, 1e-6);
    EXPECT_THAT(log.remarks, ElementsAre(HasSubstr("30 ms")));
    ASSERT_EQ(log.selections.size(), 1U);
}

}  // namespace
}  // namespace quorient::recording
