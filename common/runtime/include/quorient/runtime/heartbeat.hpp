#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace quorient::runtime {

/// Where services leave their heartbeats: $QUORIENT_RUN_DIR, else /run/quorient.
std::filesystem::path run_directory();

/// Tells from outside DDS that a service's frames are fresh: a small file, rewritten in place.
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
    explicit Heartbeat(int file) : file_(file) {}
    int file_;
};

struct Beat {
    std::int64_t steady_ns = 0;
    std::uint64_t frames = 0;
};

}  // namespace quorient::runtime
