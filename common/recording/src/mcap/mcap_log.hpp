#pragma once

#include "bytes/input.hpp"
#include "quorient/recording/instrument_log.hpp"
#include "records.hpp"

#include <map>

namespace quorient::recording::mcap {

bool is_mcap(Bytes beginning);

/// sensor_msgs/Imu of any topic, ROS 2's or ROS 1's, in an MCAP file. It is read forward: a file that was cut, or whose summary is missing,
/// is read as far as it goes. Chunks are decompressed whole, so that one that fails its checksum gives nothing.
class McapLog final : public InstrumentLog {
public:
    McapLog(Input input, std::string name);

    ReadOutcome next(InstrumentSample& sample) override;
    double progress() const override { return input_.progress(); }

private:
    /// How a channel's messages are read.
    struct Topic {
        std::string name;
        bool ros1 = false;
        std::optional<std::size_t> place;  // its instrument's
    };

    std::optional<ReadOutcome> next_in_chunk(InstrumentSample& sample);
    std::optional<ReadOutcome> next_in_file(InstrumentSample& sample);
    std::optional<ReadOutcome> record(Opcode opcode, Bytes content, InstrumentSample& sample);
    std::optional<ReadOutcome> open_chunk(std::uint64_t length);
    std::optional<ReadOutcome> message(const Message& message, InstrumentSample& sample);
    void add_channel(Bytes content);
    ReadOutcome end_of(std::uint64_t left);
    ReadOutcome refuse(std::string_view why);

    Input input_;
    std::string name_;
    std::map<std::uint16_t, std::string> schemas_;  // names
    std::map<std::uint16_t, Topic> topics_;         // those of IMUs, by channel
    std::vector<std::uint8_t> chunk_;               // its records
    std::size_t chunk_at_ = 0;                      // where its next record begins
    std::uint64_t record_ = 0;                      // offset of the file's record in hand
    bool ended_ = false;
};

}  // namespace quorient::recording::mcap
