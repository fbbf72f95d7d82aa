#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::recording::csv {

enum class Quantity { other, time, time_fraction, interval, identity, rate, increment, acceleration, temperature, counter };

/// What a column's name says: "IMU2 gyro_x [deg/s]" is the rate about x of "imu 2", in deg/s.
struct ColumnName {
    Quantity quantity = Quantity::other;
    std::optional<std::size_t> axis;  ///< 0, 1, 2 = x, y, z; of Quorient's own increments any number
    std::string owner;                ///< words that name neither quantity, axis nor unit; columns of one instrument share it
    std::string unit;                 ///< "rad/s", "deg/s", "ms" …, as spelled here; empty = not named
    std::string unknown_unit;         ///< what stands where a unit is expected, if it is none of a gyro's
    std::string text;                 ///< the name as it stands, without quotes and unit
    bool bare = false;  ///< x, y or z with no quantity, also of a named instrument: a rate only where no other column is one
    int rank = 0;                     ///< among several columns of time the highest is the best: of the sampling rather than the arrival
};

ColumnName read_column_name(std::string_view header_cell);

/// What three columns of one instrument have in common: "g0x", "g0y", "g0z" are of "g0"; "imu1/gyro/x" … of "imu1".
/// Empty where only the quantity is named: "gx", "gy", "gz".
std::string common_name(const std::array<std::string, 3>& columns);

}  // namespace quorient::recording::csv
