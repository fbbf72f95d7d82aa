#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace quorient::runtime {

/// Where services leave their heartbeats: $QUORIENT_RUN_DIR, else /run/quorient.
std::filesystem::path run_directory();

/// Whose heartbeat it is. Two systems of a host may call their processes alike; within a unit of a domain names differ.
struct HeartbeatOwner {
    std::string service;      ///< the process's name
    std::string system;       ///< the system file's `name`
    std::uint32_t domain = 0;
    std::uint32_t unit = 0;
};

/// Shows from outside DDS that a service's frames are fresh: a small file, rewritten in place.
class Heartbeat {
public:
    /// @returns nothing where the directory cannot be made or written; the service then runs without (one warning).
    static std::optional<Heartbeat> open(const HeartbeatOwner& owner);
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
    HeartbeatOwner owner;
    std::int64_t steady_ns = 0;
    std::uint64_t frames = 0;  ///< 0: none was handled yet
};

/// The last beat of every service that left one, by name, domain and unit. Files that are no heartbeats are passed over.
std::vector<Beat> read_heartbeats();

}  // namespace quorient::runtime
