#include "quorient/runtime/heartbeat.hpp"

#include "quorient/runtime/heartbeat_owner.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <tuple>
#include <utility>

namespace quorient::runtime {

namespace {

constexpr const char* extension = ".heartbeat";
constexpr std::size_t beat_length = 42;  // two numbers of 20 digits, a blank and the line's end

/// The system of this process. A process is part of one system, also when it runs several of its services, and the file of a heartbeat
/// is found by this name from outside. So it is set once, when the system file has been read, before any service opens its heartbeat.
HeartbeatOwner& owner()
{
    static HeartbeatOwner of_this_process;
    return of_this_process;
}

std::filesystem::path file_of(const std::string& stem)
{
    return run_directory() / (stem + extension);
}

std::string stem_of(const std::string& service)
{
    return fmt::format("{}.{}.{}", service, owner().domain, owner().unit);
}

/// The lines below the beat: domain and unit, service, system. Names may hold blanks, but no line ends.
std::string signature(const std::string& service)
{
    return fmt::format("{} {}\n{}\n{}\n", owner().domain, owner().unit, service, owner().system);
}

std::optional<Pulse> read_pulse(const std::filesystem::path& path)
{
    std::ifstream file{path};
    Pulse pulse;
    file >> pulse.beat.steady_ns >> pulse.beat.frames >> pulse.owner.domain >> pulse.owner.unit;
    file.ignore();
    std::getline(file, pulse.service);
    if (!std::getline(file, pulse.owner.system)) return std::nullopt;
    return pulse;
}

}  // namespace

std::filesystem::path run_directory()
{
    const char* configured = std::getenv("QUORIENT_RUN_DIR");
    return configured ? configured : "/run/quorient";
}

std::optional<Heartbeat> Heartbeat::open(const std::string& service)
{
    std::error_code ignored;  // open() below tells
    std::filesystem::create_directories(run_directory(), ignored);
    const int file = ::open(file_of(stem_of(service)).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) return std::nullopt;
    Heartbeat heartbeat{file};
    heartbeat.beat(0, 0);
    const auto whose = signature(service);
    if (::pwrite(file, whose.data(), whose.size(), beat_length) < 0) return std::nullopt;
    return heartbeat;
}

Heartbeat::~Heartbeat()
{
    if (file_ >= 0) ::close(file_);
}

Heartbeat::Heartbeat(Heartbeat&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

Heartbeat& Heartbeat::operator=(Heartbeat&& other) noexcept
{
    std::swap(file_, other.file_);
    return *this;
}

void Heartbeat::beat(std::int64_t steady_ns, std::uint64_t frames)
{
    std::array<char, 64> line{};
    std::snprintf(line.data(), line.size(), "%20" PRId64 " %20" PRIu64 "\n", steady_ns, frames);
    if (::pwrite(file_, line.data(), beat_length, 0) < 0) return;  // a full disk must not stop a service
}

void set_heartbeat_owner(HeartbeatOwner of_this_process)
{
    owner() = std::move(of_this_process);
}

std::vector<Pulse> read_pulses()
{
    std::vector<Pulse> pulses;
    std::error_code unreadable;
    for (std::filesystem::directory_iterator entry{run_directory(), unreadable}, end; !unreadable && entry != end; entry.increment(unreadable)) {
        if (entry->path().extension() != extension) continue;
        if (auto pulse = read_pulse(entry->path())) pulses.push_back(std::move(*pulse));
    }
    std::ranges::sort(pulses, {}, [](const Pulse& pulse) { return std::tie(pulse.service, pulse.owner.domain, pulse.owner.unit); });
    return pulses;
}

}  // namespace quorient::runtime
