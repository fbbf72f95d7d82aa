#include "log_seeds.hpp"

#include "writers/dataflash_writer.hpp"
#include "writers/record_writer.hpp"
#include "writers/sqlite_bag_writer.hpp"
#include "writers/ulog_writer.hpp"

namespace quorient::fuzz {

namespace {

using Seed = std::vector<std::uint8_t>;
using namespace recording::test;

Seed seed_of(const std::string& text)
{
    return {text.begin(), text.end()};
}

Seed dataflash_with_batches()
{
    DataFlashWriter writer;
    writer.format(163, 3 + 8 + 1 + 12, "IMU", "QBfff", "TimeUS,I,GyrX,GyrY,GyrZ");
    writer.units_of(163, "s#EEE", "F-000");
    writer.unit('E', "rad/s");
    writer.multiplier('0', 1);
    writer.format(164, 31, "ISBH", "QHBBHHQf", "TimeUS,N,type,instance,mul,smp_cnt,SampleUS,smp_rate");
    writer.format(165, 207, "ISBD", "QHHaaa", "TimeUS,N,seqno,x,y,z");
    const std::array<std::int16_t, 32> counts{1, 2, 3};
    writer.record(164, std::uint64_t{0}, std::uint16_t{1}, std::uint8_t{1}, std::uint8_t{0}, std::uint16_t{938}, std::uint16_t{32},
                  std::uint64_t{1000}, 2000.0F);
    writer.record(165, std::uint64_t{0}, std::uint16_t{1}, std::uint16_t{0}, counts, counts, counts);
    for (std::uint8_t i = 0; i < 6; ++i) writer.record(163, std::uint64_t{1000} * i, static_cast<std::uint8_t>(i % 2), 0.1F, 0.2F, 0.3F);
    return writer.log.data;
}

Seed ulog_of_many_topics()
{
    UlogWriter writer;
    writer.flags(1, 400);
    writer.format("sensor_gyro:uint64_t timestamp;uint32_t device_id;float x;float y;float z;uint32_t integral_dt;"
                  "float x_integral;float y_integral;float z_integral;");
    writer.format("sensor_gyro_fifo:uint64_t timestamp;float dt;float scale;uint8_t samples;int16_t[4] x;int16_t[4] y;int16_t[4] z;");
    writer.format("sensor_selection:uint64_t timestamp;uint32_t gyro_device_id;");
    writer.subscribe(1, 0, "sensor_gyro");
    writer.subscribe(2, 0, "sensor_gyro_fifo");
    writer.subscribe(3, 0, "sensor_selection");
    writer.data(3, std::uint64_t{500}, 7U);
    writer.data(1, std::uint64_t{2000}, 7U, 1.0F, 2.0F, 3.0F, 4000U, 0.02F, 0.0F, -0.04F);
    const std::array<std::int16_t, 4> counts{1, 2, 3, 4};
    writer.data(2, std::uint64_t{2500}, 125.0F, 0.5F, std::uint8_t{4}, counts, counts, counts);
    writer.dropout(12);
    writer.sync();
    return writer.log.data;
}

/// Frames outside of chunks, so that a changed byte changes a frame and not a checksum.
Seed unpacked_record()
{
    McapWriter writer;
    McapWriter::schema(writer.log, 1, "quorient_msgs::SensorFrame", "omgidl");
    McapWriter::schema(writer.log, 2, "quorient_msgs::ClusterDescription", "omgidl");
    McapWriter::channel(writer.log, 1, 1, "quorient/frame");
    McapWriter::channel(writer.log, 2, 2, "quorient/cluster");
    McapWriter::message(writer.log, 2, 1, cdr_of(description_of(4)));
    for (const auto& frame : frames_of(3)) McapWriter::message(writer.log, 1, 2, cdr_of(frame));
    writer.finish();
    return writer.log.data;
}

std::vector<Seed> tables()
{
    const std::string rows = "1.00,1,2,3,0,0,1\n1.01,1.5,2,3,0,0.1,1\n1.02,-1,2,3,0,0,1\n";
    return {seed_of("\1t_s,gx,gy,gz,ax,ay,az\n" + rows), seed_of("\2" "ts,id,Gx,Gy,Gz\n10,IMU0,1,2,3\n10,IMU1,1,2,3\n20,IMU0,1,2,3\n"),
            seed_of("\3\"time\";\"g0x [deg/s]\";\"g0y [deg/s]\";\"g0z [deg/s]\"\n2024-05-01T12:00:00,5Z;1,5;2;3\n2024-05-01T12:00:00,6Z;1,5;2;3\n"),
            seed_of("\3time,increment_0,increment_1,increment_2\n0.01,1,2,3\n0.02,1,nan,3\n"),
            seed_of("\3timestamp\tdelta_angle[0]\tdelta_angle[1]\tdelta_angle[2]\tdelta_angle_dt\n1000\t1\t2\t3\t500\n2000\t1\t2\t3\t500\n")};
}

}  // namespace

std::vector<Seed> log_seeds(const std::string& target)
{
    const std::vector<Seed> flash{dataflash_of_three_imus(8), dataflash_with_batches(),
                                  seed_of("FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
                                          "FMT, 163, 54, IMU, QBfff, TimeUS,I,GyrX,GyrY,GyrZ\nIMU, 2000, 0, 0.1, 0.2, 0.3\n")};
    const std::vector<Seed> px4{ulog_of_three_imus(8), ulog_of_many_topics()};
    if (target == "dataflash") return flash;
    if (target == "ulog") return px4;
    if (target == "csv") return tables();
    const std::vector<Seed> bags{mcap_of_two_imus(12, ""), mcap_of_two_imus(12, "zstd"), mcap_of_two_imus(12, "lz4"), record_of(frames_of(4), 2),
                                 unpacked_record()};
    if (target == "mcap") return bags;
    if (target == "times") return {Seed(512, 1), Seed(512, 17)};
    if (target == "sqlite") return {sqlite_bag_of_two_imus(4)};
    if (target != "logs") return {};
    std::vector<Seed> all = flash;
    all.insert(all.end(), px4.begin(), px4.end());
    all.insert(all.end(), bags.begin(), bags.end());
    all.push_back(sqlite_bag_of_two_imus(4));
    for (const Seed& table : tables()) all.emplace_back(table.begin() + 1, table.end());
    return all;
}

}  // namespace quorient::fuzz
