#pragma once

#include "bytes.hpp"

namespace quorient::recording::test {

/// Writes DataFlash logs as ArduPilot does.
class DataFlashWriter {
public:
    DataFlashWriter() { format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns"); }

    void format(std::uint8_t type, std::uint8_t length, const std::string& name, const std::string& letters, const std::string& labels)
    {
        header(128);
        log.put(type).put(length).put(name, 4).put(letters, 16).put(labels, 64);
    }

    void unit(char id, const std::string& label)
    {
        if (!units_) format(202, 3 + 8 + 1 + 64, "UNIT", "QbZ", "TimeUS,Id,Label");
        units_ = true;
        header(202);
        log.put(std::uint64_t{0}).put(id).put(label, 64);
    }

    void multiplier(char id, double factor)
    {
        if (!multipliers_) format(203, 3 + 8 + 1 + 8, "MULT", "Qbd", "TimeUS,Id,Mult");
        multipliers_ = true;
        header(203);
        log.put(std::uint64_t{0}).put(id).put(factor);
    }

    void units_of(std::uint8_t type, const std::string& units, const std::string& multipliers)
    {
        if (!of_formats_) format(201, 3 + 8 + 1 + 16 + 16, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds");
        of_formats_ = true;
        header(201);
        log.put(std::uint64_t{0}).put(type).put(units, 16).put(multipliers, 16);
    }

    /// A record of fields that the caller gives in the types of its format.
    template <class... Values>
    void record(std::uint8_t type, const Values&... values)
    {
        header(type);
        (log.put(values), ...);
    }

    Bytes log;

private:
    void header(std::uint8_t type) { log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(type); }

    bool units_ = false;
    bool multipliers_ = false;
    bool of_formats_ = false;
};

/// A log of three instruments as older firmware writes it: messages IMU, IMU2, IMU3 at 25 Hz.
inline std::vector<std::uint8_t> dataflash_of_three_imus(std::size_t rows)
{
    DataFlashWriter writer;
    for (std::uint8_t i = 0; i < 3; ++i)
        writer.format(static_cast<std::uint8_t>(130 + i), 3 + 8 + 24 + 8 + 4 + 2 + 4, i == 0 ? "IMU" : "IMU" + std::to_string(i + 1),
                      "QffffffIIfBBHH", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz");
    for (std::size_t row = 0; row < rows; ++row)
        for (std::uint8_t i = 0; i < 3; ++i) {
            const auto time_us = static_cast<std::uint64_t>(1'000'000 + 40'000 * row);
            const auto value = static_cast<float>(row) * 0.001F + static_cast<float>(i);
            writer.record(static_cast<std::uint8_t>(130 + i), time_us, value, -value, 2 * value, 0.1F, 0.2F, -9.8F, 0U, 0U, 35.5F,
                          std::uint8_t{1}, std::uint8_t{1}, std::uint16_t{8000}, std::uint16_t{4000});
        }
    return writer.log.data;
}

}  // namespace quorient::recording::test
