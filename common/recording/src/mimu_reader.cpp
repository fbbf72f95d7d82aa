#include "quorient/messages/name.hpp"
#include "readers.hpp"
#include "quorient/messages/meaning.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr double rate_unit_rad_s = degree / 16.4;            // per LSB
constexpr double acceleration_unit_m_s2 = 9.80665 / 2048.0;  // per LSB
constexpr double mimu_range_rad_s = 2000.0 * degree;         // the data sheet's; the codes end at 1998 deg/s

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
    copy_text("MIMU4444", board.name);
    for (std::size_t imu = 0; imu < mimu::imus; ++imu) {
        copy_text(fmt::format("IMU{}", imu + 1), board.instrument_name[imu]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t axis = 3 * imu + k;
            board.axis[axis] = imu % 2 == 0 ? upright[k] : flipped[k];
            board.position_m[axis] = position_m[imu];
            board.instrument[axis] = static_cast<std::uint8_t>(imu);
            board.quantum[axis] = rate_unit_rad_s * board.interval_s;
            board.range[axis] = mimu_range_rad_s;
        }
    }
    return board;
}

std::int64_t ns_of_ticks(std::int64_t ticks)
{
    return ticks * 125 / 8;
}  // 64 MHz

}  // namespace

MimuReader::MimuReader(Input input, std::string file)
    : input_(std::move(input)), file_(std::move(file)), clock_(ns_of_ticks(mimu::nominal_ticks))
{
    description_ = board();
    const auto beginning = input_.peek(mimu::acknowledgement.size());
    if (beginning.size() >= mimu::acknowledgement.size() &&
        std::equal(mimu::acknowledgement.begin(), mimu::acknowledgement.end(), beginning.begin()))
        input_.take(mimu::acknowledgement.size());
}

/// Looks at the bytes of a packet; false where the log ends before.
bool MimuReader::fill()
{
    const auto bytes = input_.peek(mimu::packet_size);
    packet_ = bytes.first(std::min(bytes.size(), mimu::packet_size));
    return packet_.size() == mimu::packet_size;
}

ReadOutcome MimuReader::next(RecordedFrame& frame)
{
    if (!fill()) return cut_off();
    record_ = input_.offset();
    if (!mimu::intact(packet_)) return resynchronise();

    ++statistics_.records;
    const bool accepted = in_time();
    if (accepted) decode(frame);
    input_.take(mimu::packet_size);
    if (!accepted) return ReadOutcome::rejected;
    ++statistics_.frames;
    return ReadOutcome::frame;
}

ReadOutcome MimuReader::cut_off()
{
    if (ended_) return ReadOutcome::end;
    ended_ = true;
    record_ = input_.offset();
    statistics_.truncated_bytes = packet_.size();
    input_.take(packet_.size());
    if (!input_.trouble().empty()) return refuse(input_.trouble());
    if (statistics_.truncated_bytes == 0) return ReadOutcome::end;
    return refuse(fmt::format("the log ends {} bytes into a packet of {}", statistics_.truncated_bytes, mimu::packet_size));
}

/// Passes over a broken packet to the next intact one.
ReadOutcome MimuReader::resynchronise()
{
    const bool framed = mimu::starts_like_packet(packet_);
    ++(framed ? statistics_.checksum_failures : statistics_.malformed);
    ++statistics_.records;
    const auto why = framed ? fmt::format("checksum is 0x{:04X}, the packet says 0x{:04X}", mimu::checksum(packet_),
                                          mimu::u16(packet_, mimu::packet_size - 2))
                            : fmt::format("no packet starts here (0x{:02X} … 0x{:02X})", packet_[0], packet_[3]);
    std::uint64_t skipped = 0;
    do {
        input_.take(1);
        ++skipped;
    } while (fill() && !mimu::intact(packet_));
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
    const std::uint16_t number = mimu::number(packet_);
    const std::uint32_t ticks = mimu::ticks(packet_);
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
    const std::int64_t step_ns = backwards ? -1 : ns_of_ticks(static_cast<std::int64_t>(numbers) * mimu::nominal_ticks + excess_ticks);
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
            frame.increment[3 * imu + k] = mimu::rate(packet_, imu, k) * rate_unit_rad_s * interval_s_;
            frame.acceleration_m_s2[3 * imu + k] = mimu::acceleration(packet_, imu, k) * acceleration_unit_m_s2;
        }
    }
    last_frame_ns_ = frame.time_ns;
}

}  // namespace quorient::recording
