// How fast logs are read, and in how much memory: recording_log_speed KIND MEGABYTES FILE writes a log of three instruments that turn, then
// reads it as a diagnosis does (survey, clocks, common intervals) and prints both. KIND: dataflash, ulog, csv, long-csv, mcap or sqlite.

#include "quorient/recording/aligned_logs.hpp"

#include "writers/dataflash_writer.hpp"
#include "writers/sqlite_bag_writer.hpp"
#include "writers/ulog_writer.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <span>
#include <string>
#include <tuple>

namespace quorient::recording {
namespace {

using test::ByteVector;

constexpr double rate_hz = 1000;
constexpr std::size_t instruments = 3;

/// A log of so many bytes, written piece by piece.
class File {
public:
    File(const std::string& name, std::uint64_t size) : stream_(name, std::ios::binary), size_(size) {}

    void put(ByteVector& bytes)
    {
        stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        written_ += bytes.size();
        bytes.clear();
    }

    bool wants_more() const { return written_ < size_; }
    bool finish() { return static_cast<bool>(stream_.flush()); }

private:
    std::ofstream stream_;
    std::uint64_t size_;
    std::uint64_t written_ = 0;
};

std::array<float, 3> rates_at(std::uint64_t row, std::size_t instrument)
{
    const double t = static_cast<double>(row) / rate_hz;
    const double turn = std::sin(0.9 * t) + 0.5 * std::sin(2.3 * t) + 1e-3 * static_cast<double>((row * 7919 + instrument * 104729) % 64);
    return {static_cast<float>(turn), static_cast<float>(0.3 * turn), static_cast<float>(std::cos(0.4 * t))};
}

std::uint64_t time_us(std::uint64_t row)
{
    return 1'000'000 + row * static_cast<std::uint64_t>(1e6 / rate_hz);
}

void write_dataflash(File& file)
{
    test::DataFlashWriter writer;
    writer.format(163, 3 + 8 + 1 + 24 + 8 + 4 + 2 + 4, "IMU", "QBffffffIIfBBHH", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz");
    for (std::uint64_t row = 0; file.wants_more(); ++row) {
        for (std::uint8_t i = 0; i < instruments; ++i)
            writer.record(163, time_us(row), i, rates_at(row, i), std::array<float, 3>{0.1F, 0.2F, -9.8F}, 0U, 0U, 35.5F, std::uint8_t{1},
                          std::uint8_t{1}, std::uint16_t{1000}, std::uint16_t{1000});
        file.put(writer.log.data);
    }
}

void write_ulog(File& file)
{
    test::UlogWriter writer;
    writer.format("sensor_gyro:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float y;float z;float temperature;"
                  "uint32_t error_count;uint8_t[3] clip_counter;uint8_t samples;");
    for (std::uint8_t i = 0; i < instruments; ++i) writer.subscribe(i, i, "sensor_gyro");
    for (std::uint64_t row = 0; file.wants_more(); ++row) {
        for (std::uint8_t i = 0; i < instruments; ++i)
            writer.data(i, time_us(row) + 100, time_us(row), 100U + i, rates_at(row, i), 41.0F, 0U, std::array<std::uint8_t, 4>{0, 0, 0, 8});
        file.put(writer.log.data);
    }
}

void write_csv(File& file)
{
    std::string text = "time_us,g0x_rad_s,g0y_rad_s,g0z_rad_s,g1x_rad_s,g1y_rad_s,g1z_rad_s,g2x_rad_s,g2y_rad_s,g2z_rad_s\n";
    for (std::uint64_t row = 0; file.wants_more(); ++row) {
        text += std::to_string(time_us(row));
        for (std::size_t i = 0; i < instruments; ++i)
            for (const float rate : rates_at(row, i)) text += fmt::format(",{:.6f}", rate);
        text += '\n';
        ByteVector bytes(text.begin(), text.end());
        file.put(bytes);
        text.clear();
    }
}

void write_long_csv(File& file)
{
    std::string text = "time_us,id,gx_rad_s,gy_rad_s,gz_rad_s\n";
    for (std::uint64_t row = 0; file.wants_more(); ++row) {
        for (std::size_t i = 0; i < instruments; ++i) {
            const auto rates = rates_at(row, i);
            text += fmt::format("{},IMU{},{:.6f},{:.6f},{:.6f}\n", time_us(row), i, rates[0], rates[1], rates[2]);
        }
        ByteVector bytes(text.begin(), text.end());
        file.put(bytes);
        text.clear();
    }
}

ByteVector message_at(std::uint64_t row, std::size_t instrument)
{
    const auto rates = rates_at(row, instrument);
    return test::cdr_imu(static_cast<std::int32_t>(time_us(row) / 1'000'000), static_cast<std::uint32_t>(time_us(row) % 1'000'000) * 1000,
                         {rates[0], rates[1], rates[2]});
}

void write_mcap(File& file)
{
    test::McapWriter writer;
    test::Bytes records;
    test::McapWriter::schema(records, 1, "sensor_msgs/msg/Imu");
    for (std::uint16_t i = 0; i < instruments; ++i) test::McapWriter::channel(records, i, 1, "/imu/" + std::to_string(i));
    for (std::uint64_t row = 0; file.wants_more(); ++row) {
        for (std::uint16_t i = 0; i < instruments; ++i) test::McapWriter::message(records, i, time_us(row) * 1000, message_at(row, i));
        if (row % 1000 != 999) continue;
        writer.chunk(records, "");
        records.data.clear();
        file.put(writer.log.data);
    }
    writer.finish();
    file.put(writer.log.data);
}

void write_sqlite(const std::string& name, std::uint64_t size)
{
    test::SqliteBagWriter bag(name);
    for (int i = 0; i < static_cast<int>(instruments); ++i) bag.topic(i + 1, "/imu/" + std::to_string(i), "sensor_msgs/msg/Imu");
    const std::uint64_t rows = size / (instruments * (message_at(0, 0).size() + 20));
    for (std::uint64_t row = 0; row < rows; ++row)
        for (std::size_t i = 0; i < instruments; ++i)
            bag.message(static_cast<int>(i) + 1, static_cast<std::int64_t>(time_us(row) * 1000), message_at(row, i));
}

bool write(const std::string& kind, std::uint64_t size, const std::string& name)
{
    if (kind == "sqlite") {
        write_sqlite(name, size);
        return true;
    }
    File file(name, size);
    if (kind == "dataflash") write_dataflash(file);
    else if (kind == "ulog") write_ulog(file);
    else if (kind == "csv") write_csv(file);
    else if (kind == "long-csv") write_long_csv(file);
    else if (kind == "mcap") write_mcap(file);
    else return false;
    return file.finish();
}

double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// @returns the time that each of the two passes took [s], and the frames of the second
tl::expected<std::tuple<double, double, std::uint64_t>, std::string> read(const std::filesystem::path& file)
{
    const auto begin = std::chrono::steady_clock::now();
    auto found = survey(std::span(&file, 1), {});
    if (!found) return tl::unexpected(found.error());
    if (const auto tied = tie_clocks(*found); !tied) return tl::unexpected(tied.error());
    const double survey_s = seconds_since(begin);
    auto logs = AlignedLogs::open(*found);
    if (!logs) return tl::unexpected(logs.error());
    AlignedFrame frame;
    std::uint64_t frames = 0;
    for (auto outcome = logs->next(frame); outcome != ReadOutcome::end; outcome = logs->next(frame)) frames += outcome == ReadOutcome::frame ? 1 : 0;
    return std::tuple(survey_s, seconds_since(begin) - survey_s, frames);
}

}  // namespace
}  // namespace quorient::recording

int main(int argc, char** argv)
{
    using namespace quorient::recording;
    if (argc != 4 || !write(argv[1], std::stoull(argv[2]) << 20U, argv[3])) {
        fmt::print(stderr, "usage: recording_log_speed dataflash|ulog|csv|long-csv|mcap|sqlite MEGABYTES FILE\n");
        return 2;
    }
    const auto done = read(argv[3]);
    if (!done) {
        fmt::print(stderr, "{}\n", done.error());
        return 1;
    }
    const double megabytes = static_cast<double>(std::filesystem::file_size(argv[3])) / (1 << 20U);
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto [survey_s, frames_s, frames] = *done;
    fmt::print("| {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {} | {} |\n", argv[1], megabytes, megabytes / survey_s, megabytes / frames_s,
               megabytes / (survey_s + frames_s), frames, usage.ru_maxrss / 1024);
    return 0;
}
