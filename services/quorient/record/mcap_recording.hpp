#pragma once

#include "mcap_file.hpp"
#include "sample_queue.hpp"

#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace quorient::record {

/// When a recording goes on in another file.
struct Rotation {
    std::optional<double> after_mb;
    std::optional<double> after_s;

    bool is_asked() const { return after_mb || after_s; }
};

/// A recording in MCAP: take() on the DDS thread, a thread of its own that compresses and writes. With a rotation FILE.mcap becomes
/// FILE_0000.mcap, FILE_0001.mcap, …; each of them begins with the newest description, and can be read without the others.
class McapRecording {
public:
    /// Looks at the names; the first file is made with the first sample. @throws cli::Exit where a file cannot be written or exists already
    McapRecording(std::string file, bool force, Rotation rotation);
    ~McapRecording();

    /// DDS thread; never waits. A sample without room in the queue is dropped and counted.
    template <class Message>
    void take(const bus::Topic<Message>& topic, const Message& message, std::int64_t wall_ns);

    /// The file could not be written, as stderr says already. Nothing more is taken.
    bool failed() const { return failed_; }

    struct Result {
        std::vector<std::string> files;
        std::uint64_t samples = 0;  ///< in the files, the viewers' messages included
        std::uint64_t frames = 0;   ///< in the files
        std::uint64_t dropped = 0;
    };

    /// Writes what is left and ends the file.
    Result finish();

private:
    void run();
    void write(const SampleQueue::Header& header, std::span<const std::uint8_t> cdr);
    void open_next(std::uint64_t log_time_ns);
    void close();
    bool is_rotation_due() const;
    std::string next_name() const;

    std::string name_;
    bool force_;
    Rotation rotation_;
    SampleQueue queue_;
    std::atomic<bool> failed_ = false;
    std::unique_ptr<McapFile> file_;          // from here on: the writing thread's, until it is joined
    std::vector<std::uint8_t> description_;   // the newest, as CDR
    Result result_;
    std::thread thread_;
};

template <class Message>
void McapRecording::take(const bus::Topic<Message>& topic, const Message& message, std::int64_t wall_ns)
{
    // Types of the wire contract are their own memory image in little-endian CDR (idl/README.md).
    std::array<std::uint8_t, 4 + sizeof message> cdr{0, 1, 0, 0};
    std::memcpy(cdr.data() + 4, &message, sizeof message);
    queue_.push(channel_of(topic.spec.type), static_cast<std::uint64_t>(wall_ns), cdr);
}

}  // namespace quorient::record
