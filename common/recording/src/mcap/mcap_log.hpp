#pragma once

#include "quorient/recording/instrument_log.hpp"
#include "record_stream.hpp"

#include <map>
#include <set>

namespace quorient::recording::mcap {

/// sensor_msgs/Imu of any topic, ROS 2's or ROS 1's, in an MCAP file.
class McapLog final : public InstrumentLog {
public:
    McapLog(Input input, std::string name);

    ReadOutcome next(InstrumentSample& sample) override;
    double progress() const override { return records_.progress(); }

private:
    /// How a channel's messages are read.
    struct Topic {
        std::string name;
        bool ros1 = false;
        std::optional<std::size_t> place;  // its instrument's
    };

    std::optional<ReadOutcome> record(InstrumentSample& sample);
    std::optional<ReadOutcome> message(const Message& message, InstrumentSample& sample);
    void add_channel(Bytes content);
    ReadOutcome end();
    ReadOutcome refuse(std::string_view why);

    RecordStream records_;
    std::string name_;
    std::set<std::uint16_t> schemas_;               // those of IMUs
    std::map<std::uint16_t, Topic> topics_;         // those of IMUs, by channel
};

}  // namespace quorient::recording::mcap
