#pragma once

#include "cli/output_file.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/recording/mcap_writer.hpp"
#include "viewer_messages.hpp"

#include <chrono>
#include <span>
#include <string>

namespace quorient::record {

/// Each topic of the wire contract has a channel of its own. The viewers' channels follow.
constexpr std::uint16_t channel_of(bus::TypeId type)
{
    return static_cast<std::uint16_t>(static_cast<std::size_t>(type) + 1);
}

/// One MCAP file of a recording: every topic's schema and channel, and the messages for viewers beside the voted attitude.
class McapFile {
public:
    /// @throws cli::Exit as cli::OutputFile does
    McapFile(const std::string& name, bool force);

    /// @param cdr  with the four bytes in front
    void add(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::uint8_t> cdr);

    /// Writes what has been added, once a second: a process that is killed loses no more than that.
    void flush_when_due();

    /// The system's reason why the file could not be written; empty where it could.
    const std::string& failure() { return output_.failure(); }

    /// Writes the summary, or cuts a file that could not be written behind its last whole record.
    /// @returns false where the file is not whole on the disk, after the reason has been explained on stderr
    bool finish();

    std::uint64_t size() const { return writer_.size(); }
    std::chrono::steady_clock::time_point opened() const { return opened_; }
    std::uint64_t samples() const { return writer_.written(); }  ///< the viewers' messages included
    std::uint64_t frames() const;
    const std::string& name() const { return output_.name(); }

private:
    void add_viewer_messages(std::uint64_t log_time_ns, std::span<const std::uint8_t> voted_cdr);
    void add_channels();

    cli::OutputFile output_;
    recording::mcap::Writer writer_;
    ViewerMessages viewers_;
    std::uint16_t transform_channel_ = 0;
    std::uint16_t imu_channel_ = 0;
    std::chrono::steady_clock::time_point opened_;
    std::chrono::steady_clock::time_point flushed_;
};

}  // namespace quorient::record
