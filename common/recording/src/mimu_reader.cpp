#include "readers.hpp"
#include "quorient/messages/meaning.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr std::size_t buffer_size = 1U << 16U;
constexpr double rate_unit_rad_s = degree / 16.4;            // per LSB
constexpr double acceleration_unit_m_s2 = 9.80665 / 2048.0;  // per LSB
constexpr double range_rad_s = 2000.0 * degree;              // the data sheet's; the codes end at 1998 deg/s

/// Odd IMUs (1, 3 …) are mounted as the body; the even ones are flipped, body = (-y, -x, -z): where their x, y, z axes point.
constexpr std::array<std::array<double, 3>, 3> upright{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<std::array<double, 3>, 3> flipped{{{0, -1, 0}, {-1, 0, 0}, {0, 0, -1}}};

/// IMU positions [m], from IMU_positions.csv of the recordings.
constexpr std::array<std::array<double, 3>, mimu::imus> position_m{{{-0.00945, 0.00945, 0.001},
                                                                    {-0.00945, 0.00945, -0.001},
                                                                    {-0.00945, -0.00945, 0.001},
                                                                    {-0.00945, -0.00945, -0.001},
                                                                    {0.00945, 0.00945, 0.001},
                                                                    {0.00945, 0.00945, -0.001},
                                                                    {0.00945, -0.00945, 0.001},
                                                                    {0.00945, -0.00945, -0.001}}};

ClusterDescription board()
{
    ClusterDescription board;
    board.interval_s = mimu::nominal_ticks / mimu::ticks_per_second;
    board.kind = octet(SensorKind::gyro);
    board.axis_count = 3 * mimu::imus;
    board.instrument_count = mimu::imus;
    set_name(board.name, "MIMU4444");
    for (std::size_t imu = 0; imu < mimu::imus; ++imu) {
        set_name(board.instrument_name[imu], fmt::format("IMU{}", imu + 1));
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t axis = 3 * imu + k;
            board.axis[axis] = imu % 2 == 0 ? upright[k] : flipped[k];
            board.position_m[axis] = position_m[imu];
            board.instrument[axis] = static_cast<std::uint8_t>(imu);
            board.quantum[axis] = rate_unit_rad_s * board.interval_s;
            board.range[axis] = range_rad_s;
        }
    }
    return board;
}

std::int64_t nanoseconds(std::int64_t ticks)
{
    return ticks * 125 / 8;
}  // 64 MHz

}  // namespace

MimuReader::MimuReader(const std::filesystem::path& file)
    : stream_(file, std::ios::binary), file_(file.filename().string()), buffer_(buffer_size), clock_(nanoseconds(mimu::nominal_ticks))
{
    description_ = board();
    if (fill() && std::equal(mimu::acknowledgement.begin(), mimu::acknowledgement.end(), buffer_.begin())) {
        begin_ = mimu::acknowledgement.size();
        offset_ = begin_;
    }
}

/// Makes sure that a whole packet lies in the buffer at begin_; false at the end of the file.
bool MimuReader::fill()
{
    if (end_ - begin_ >= mimu::packet_size) return true;
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
    stream_.read(reinterpret_cast<char*>(buffer_.data() + end_), static_cast<std::streamsize>(buffer_.size() - end_));
    end_ += static_cast<std::size_t>(stream_.gcount());
    return end_ >= mimu::packet_size;
}

ReadOutcome MimuReader::next(RecordedFrame& frame)
{
    if (!fill()) return cut_off();
    record_ = offset_;
    if (!mimu::intact(packet())) return resynchronise();

    ++statistics_.records;
    const bool accepted = in_time();
    if (accepted) decode(frame);
    begin_ += mimu::packet_size;
    offset_ += mimu::packet_size;
    if (!accepted) return ReadOutcome::rejected;
    ++statistics_.frames;
    return ReadOutcome::frame;
}

ReadOutcome MimuReader::cut_off()
{
    if (end_ == begin_) return ReadOutcome::end;
    record_ = offset_;
    statistics_.truncated_bytes = end_ - begin_;
    begin_ = end_ = 0;
    return refuse(fmt::format("the log ends {} bytes into a packet of {}", statistics_.truncated_bytes, mimu::packet_size));
}

/// Passes over a broken packet to the next intact one.
ReadOutcome MimuReader::resynchronise()
{
    const bool framed = mimu::starts_like_packet(packet());
    ++(framed ? statistics_.checksum_failures : statistics_.malformed);
    ++statistics_.records;
    const auto why = framed ? fmt::format("checksum is 0x{:04X}, the packet says 0x{:04X}", mimu::checksum(packet()),
                                          mimu::u16(packet(), mimu::packet_size - 2))
                            : fmt::format("no packet starts here (0x{:02X} … 0x{:02X})", packet()[0], packet()[3]);
    std::uint64_t skipped = 0;
    do {
        ++begin_;
        ++offset_;
        ++skipped;
    } while (fill() && !mimu::intact(packet()));
    statistics_.skipped_bytes += skipped;
    ++refused_;
    return refuse(fmt::format("{}; {} bytes passed over", why, skipped));
}

ReadOutcome MimuReader::refuse(std::string_view why)
{
    problem_ = fmt::format("{}: byte {}: {}", file_, record_, why);
    return ReadOutcome::rejected;
}

/// Judges number and clock of the packet in hand against those of the one before, and adopts them.
bool MimuReader::in_time()
{
    const std::uint16_t number = mimu::number(packet());
    const std::uint32_t ticks = mimu::ticks(packet());
    const auto numbers = static_cast<std::uint16_t>(number - number_);
    const auto expected_ticks = static_cast<std::uint32_t>(numbers) * mimu::nominal_ticks;
    const auto excess_ticks =
        static_cast<std::int32_t>(ticks - ticks_ - expected_ticks);  // modulo 2^32: the counter starts over every 67 s
    const std::uint16_t last_number = number_;
    number_ = number;
    ticks_ = ticks;
    if (!started_) {
        started_ = true;
        interval_s_ = description_.interval_s;
        return true;
    }
    if (numbers == 0) {
        ++statistics_.repeated;
        refuse(fmt::format("packet number {} again", number));
        return false;
    }
    const bool backwards = numbers > 0x8000;
    const std::int64_t step_ns = backwards ? -1 : nanoseconds(static_cast<std::int64_t>(numbers) * mimu::nominal_ticks + excess_ticks);
    const auto step = clock_.advance(step_ns);
    statistics_.duration_ns = clock_.elapsed_ns();
    if (step == LogClock::Step::repeated || step == LogClock::Step::irregular ||
        std::abs(excess_ticks) > static_cast<std::int32_t>(mimu::nominal_ticks / 4)) {
        ++statistics_.irregular;
        refuse(fmt::format("packet number {} -> {} and clock step of {:.6f} s do not fit", last_number, number,
                           static_cast<double>(step_ns) * 1e-9));
        return false;
    }
    interval_s_ = static_cast<double>(step_ns) * 1e-9 / numbers;
    const std::uint64_t missing = numbers - 1U;
    statistics_.lost += missing - std::min<std::uint64_t>(missing, refused_);
    refused_ = 0;
    return true;
}

void MimuReader::decode(RecordedFrame& frame)
{
    frame.time_ns = clock_.elapsed_ns() + clock_.nominal_ns();
    frame.interval_s = interval_s_;
    frame.lost_before = clock_.intervals(frame.time_ns - last_frame_ns_) - 1;
    frame.position = record_;
    frame.axis_count = description_.axis_count;
    frame.valid_mask = frame.acceleration_mask = all_axes(frame.axis_count);
    frame.truth.reset();
    for (std::size_t imu = 0; imu < mimu::imus; ++imu) {
        for (std::size_t k = 0; k < 3; ++k) {
            frame.increment[3 * imu + k] = mimu::rate(packet(), imu, k) * rate_unit_rad_s * interval_s_;
            frame.acceleration_m_s2[3 * imu + k] = mimu::acceleration(packet(), imu, k) * acceleration_unit_m_s2;
        }
    }
    last_frame_ns_ = frame.time_ns;
}

}  // namespace quorient::recording
