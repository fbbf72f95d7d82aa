#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace quorient::runtime {

/// Where services leave their heartbeats: $QUORIENT_RUN_DIR, else /run/quorient.
std::filesystem::path run_directory();

/// Shows outside DDS that a service's frames are fresh: a small file, rewritten in place. Its last line is a sum of the others. So a
/// reader notices a beat that is half written, and reads it again.
class Heartbeat {
public:
    /// @returns nothing where the directory cannot be made or written; the service then runs without (one warning).
    static std::optional<Heartbeat> open(const std::string& service);
    ~Heartbeat();
    Heartbeat(Heartbeat&& other) noexcept;
    Heartbeat& operator=(Heartbeat&& other) noexcept;

    /// @param steady_ns  when this service last handled a frame; the host's steady clock.
    void beat(std::int64_t steady_ns, std::uint64_t frames);

private:
    Heartbeat(int file, std::string text) : file_(file), text_(std::move(text)) {}
    int file_;
    std::string text_;  ///< what the file holds; a beat allocates nothing
};

struct Beat {
    std::int64_t steady_ns = 0;
    std::uint64_t frames = 0;
};

}  // namespace quorient::runtime
