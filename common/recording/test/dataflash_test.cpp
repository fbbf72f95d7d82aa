#include "instrument_log_test.hpp"
#include "writers/dataflash_writer.hpp"

#include <gmock/gmock.h>
#include <cmath>

namespace quorient::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using test::DataFlashWriter;

constexpr double degree = 3.14159265358979323846 / 180;

TEST(DataFlash, calls_its_instruments_as_the_log_does)
{
    const Samples log = samples_of(test::dataflash_of_three_imus(10));
    EXPECT_EQ(log.format, "ArduPilot DataFlash");
    EXPECT_THAT(log.names(), ElementsAre("IMU", "IMU2", "IMU3"));
    EXPECT_TRUE(log.problems.empty());
    ASSERT_EQ(log.of("IMU3").size(), 10U);
    const InstrumentSample sample = log.of("IMU3")[4];
    EXPECT_EQ(sample.time_ns, 1'160'000'000);
    EXPECT_EQ(sample.covered_s, 0) << "an IMU row is the rate at its time";
    EXPECT_FLOAT_EQ(static_cast<float>(sample.rate_rad_s[0]), 2.004F);
    EXPECT_FLOAT_EQ(static_cast<float>(sample.rate_rad_s[1]), -2.004F);
    EXPECT_FLOAT_EQ(static_cast<float>(sample.acceleration_m_s2[2]), -9.8F);
    EXPECT_EQ(sample.temperature_c, 35.5);
    EXPECT_FALSE(sample.clipped) << "ArduPilot logs no clipping of gyros: unknown, not unclipped";
}

TEST(DataFlash, finds_fields_by_name_wherever_they_stand_and_instances_by_their_field)
{
    DataFlashWriter writer;
    writer.format(163, 3 + 1 + 4 + 8 + 12 + 2, "IMU", "BfQfffh", "I,T,TimeUS,GyrZ,GyrY,GyrX,New");
    for (std::uint8_t row = 0; row < 6; ++row)
        writer.record(163, static_cast<std::uint8_t>(row % 2), 20.0F + row, std::uint64_t{1000} * row, 3.0F, 2.0F, 1.0F, std::int16_t{7});
    const Samples log = samples_of(writer.log.data);
    EXPECT_THAT(log.names(), ElementsAre("IMU[0]", "IMU[1]"));
    ASSERT_EQ(log.of("IMU[1]").size(), 3U);
    EXPECT_THAT(log.of("IMU[1]")[0].rate_rad_s, ElementsAre(1.0, 2.0, 3.0));
    EXPECT_EQ(log.of("IMU[1]")[0].temperature_c, 21.0);
}

TEST(DataFlash, takes_units_and_multipliers_from_the_log)
{
    DataFlashWriter writer;
    writer.format(162, 3 + 8 + 1 + 8 + 6, "GYR", "QBQhhh", "TimeUS,I,SampleUS,GyrX,GyrY,GyrZ");
    writer.units_of(162, "s#skkk", "F-FBBB");
    writer.unit('k', "deg/s");
    writer.multiplier('B', 0.01);
    writer.record(162, std::uint64_t{5000}, std::uint8_t{0}, std::uint64_t{4000}, std::int16_t{9000}, std::int16_t{-100}, std::int16_t{1});
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.samples.size(), 1U);
    EXPECT_EQ(log.names()[0], "GYR[0]");
    EXPECT_EQ(log.instruments[0].stamps, StampKind::sampling);
    EXPECT_EQ(log.samples[0].time_ns, 4'000'000) << "the time of the sample, not of the row";
    EXPECT_NEAR(log.samples[0].rate_rad_s[0], 90 * degree, 1e-12);
    EXPECT_NEAR(log.samples[0].rate_rad_s[1], -degree, 1e-12);
}

TEST(DataFlash, divides_increments_by_their_own_time)
{
    DataFlashWriter writer;
    writer.format(140, 3 + 8 + 24, "IMT2", "Qffffff", "TimeUS,DelT,DelvT,DelaT,DelAX,DelAY,DelAZ");
    writer.record(140, std::uint64_t{1'000'000}, 0.01F, 0.01F, 0.005F, 0.01F, 0.0F, -0.02F);
    writer.record(140, std::uint64_t{9'000'000}, 0.01F, 0.01F, 0.005F, 0.01F, 0.0F, -0.02F);
    writer.record(140, std::uint64_t{9'010'000}, 0.01F, 0.01F, 0.0F, 0.01F, 0.0F, -0.02F);
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.of("IMT2").size(), 2U) << "an increment over no time is no rate";
    EXPECT_EQ(log.statistics.malformed, 1U);
    EXPECT_NEAR(log.samples[1].rate_rad_s[0], 2.0, 1e-6) << "whatever is missing before it";
    EXPECT_NEAR(log.samples[1].covered_s, 0.005, 1e-9);
}

TEST(DataFlash, reads_batches_at_the_sensors_own_rate)
{
    DataFlashWriter writer;
    writer.format(164, 31, "ISBH", "QHBBHHQf", "TimeUS,N,type,instance,mul,smp_cnt,SampleUS,smp_rate");
    writer.format(165, 207, "ISBD", "QHHaaa", "TimeUS,N,seqno,x,y,z");
    std::array<std::int16_t, 32> ramp{};
    for (std::int16_t i = 0; i < 32; ++i) ramp[static_cast<std::size_t>(i)] = i;
    const auto head = [&](std::uint16_t number, std::uint8_t type, std::uint8_t instance) {
        writer.record(164, std::uint64_t{0}, number, type, instance, std::uint16_t{100}, std::uint16_t{64}, std::uint64_t{500'000}, 2000.0F);
    };
    const auto data = [&](std::uint16_t number, std::uint16_t part) { writer.record(165, std::uint64_t{0}, number, part, ramp, ramp, ramp); };
    head(3, 1, 1);
    data(3, 0);
    data(3, 1);
    head(4, 0, 1);
    data(4, 0);
    data(9, 0);
    const Samples log = samples_of(writer.log.data);
    EXPECT_THAT(log.names(), ElementsAre("ISBD[1]"));
    ASSERT_EQ(log.samples.size(), 64U) << "accelerometers' batches, and those without a head, are left out";
    EXPECT_EQ(log.samples[0].time_ns, 500'000'000);
    EXPECT_EQ(log.samples[33].time_ns, 500'000'000 + 33 * 500'000);
    EXPECT_NEAR(log.samples[33].rate_rad_s[2], 0.01, 1e-12);
}

TEST(DataFlash, loses_no_more_than_what_is_damaged)
{
    auto bytes = test::dataflash_of_three_imus(100);
    const std::size_t at = 89 * 4 + 53 * 90;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), 60, std::uint8_t{0});
    bytes.resize(bytes.size() - 20);
    const Samples log = samples_of(bytes);
    EXPECT_EQ(log.samples.size(), 300U - 2 - 1);
    ASSERT_EQ(log.problems.size(), 2U);
    EXPECT_THAT(log.problems[0], AllOf(HasSubstr("byte " + std::to_string(at)), HasSubstr("106 bytes passed over")));
    EXPECT_THAT(log.problems[1], HasSubstr("33 bytes into a record"));
    EXPECT_EQ(log.statistics.truncated_bytes, 33U);
    EXPECT_EQ(log.statistics.skipped_bytes, 106U);
}

TEST(DataFlash, does_not_read_messages_whose_fields_do_not_fill_them)
{
    DataFlashWriter writer;
    writer.format(130, 40, "IMU", "Qfff", "TimeUS,GyrX,GyrY,GyrZ");
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.remarks.size(), 1U);
    EXPECT_THAT(log.remarks[0], HasSubstr("40 bytes"));
}

TEST(DataFlash, reads_the_text_form_alike)
{
    const std::string text =
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
        "FMT, 133, 53, IMU, QffffffIIfBBHH, TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz\r\n"
        "FMT, 163, 54, IMU2, QBfff, TimeUS,I,GyrX,GyrY,GyrZ\n"
        "PARM, 12345, INS_ENABLE_MASK, 127\n"
        "IMU, 208659484, 0.0053, -0.00045, 0.00078, 0.157, 0.255, -9.82, 0, 0, 35.4, 1, 1, 8005, 4002\n"
        "IMU2, 208659484, 1, 1.5, 2.5, -3.5\n"
        "IMU, 208699484, 0.0053, zwei, 0.00078, 0.157, 0.255, -9.82, 0, 0, 35.4, 1, 1, 8005, 4002\n"
        "IMU, 208739484, 0.0053\n";
    const Samples log = samples_of(text);
    EXPECT_EQ(log.format, "ArduPilot DataFlash, text");
    EXPECT_THAT(log.names(), ElementsAre("IMU", "IMU2[1]"));
    ASSERT_EQ(log.samples.size(), 2U);
    EXPECT_EQ(log.samples[0].time_ns, 208'659'484'000);
    EXPECT_EQ(log.samples[0].rate_rad_s[1], -0.00045);
    EXPECT_EQ(log.samples[1].rate_rad_s[2], -3.5);
    EXPECT_THAT(log.problems, ElementsAre(AllOf(HasSubstr(":7:"), HasSubstr("zwei")), HasSubstr(":8:")));
}

struct Counts {
    const char* file;
    std::vector<std::pair<std::string, std::size_t>> samples;
};

TEST(DataFlash, finds_in_real_logs_what_an_independent_program_counts)
{
    if (!std::filesystem::exists(field_dir())) GTEST_SKIP() << "no logs under " << field_dir();
    // Counted by a script of its own over the same files.
    const std::vector<Counts> expected{{"ardupilot_3_imus_crash.bin", {{"IMU", 1480}, {"IMU2", 1480}, {"IMU3", 1480}}},
                                       {"ardupilot_2_imus_hole.bin", {{"IMU", 1820}, {"IMU2", 1820}}},
                                       {"ardupilot_46_instances.bin", {{"ISBD[0]", 18 * 32}, {"IMU[0]", 10}, {"IMU[1]", 10}}}};
    for (const Counts& counts : expected) {
        SCOPED_TRACE(counts.file);
        const Samples log = samples_of(open_instruments(field_dir() / counts.file));
        EXPECT_EQ(log.instruments.size(), counts.samples.size());
        for (const auto& [name, count] : counts.samples) EXPECT_EQ(log.of(name).size(), count) << name;
    }
    const Samples crash = samples_of(open_instruments(field_dir() / "ardupilot_3_imus_crash.bin"));
    EXPECT_EQ(crash.statistics.truncated_bytes, 23U);
    double fastest = 0;
    for (const InstrumentSample& sample : crash.samples)
        fastest = std::max(fastest, std::hypot(sample.rate_rad_s[0], sample.rate_rad_s[1], sample.rate_rad_s[2]));
    EXPECT_NEAR(fastest / degree, 1100, 100) << "a tumble of 1070 deg/s";
    std::int64_t longest_ns = 0;
    const auto hole = samples_of(open_instruments(field_dir() / "ardupilot_2_imus_hole.bin")).of("IMU");
    for (std::size_t i = 1; i < hole.size(); ++i) longest_ns = std::max(longest_ns, hole[i].time_ns - hole[i - 1].time_ns);
    EXPECT_NEAR(static_cast<double>(longest_ns) * 1e-9, 627.9, 0.1);
}

}  // namespace
}  // namespace quorient::recording
