#include "quorient/runtime/heartbeat.hpp"

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

std::filesystem::path file_of(const HeartbeatOwner& owner)
{
    return run_directory() / fmt::format("{}.{}.{}{}", owner.service, owner.domain, owner.unit, extension);
}

/// Two lines: the beat, of fixed width and rewritten in place, and whose it is. Names may hold blanks, but no line ends.
std::optional<Beat> read(const std::filesystem::path& path)
{
    std::ifstream file{path};
    Beat beat;
    file >> beat.steady_ns >> beat.frames >> beat.owner.domain >> beat.owner.unit;
    file.ignore();
    std::getline(file, beat.owner.service);
    if (!std::getline(file, beat.owner.system)) return std::nullopt;
    return beat;
}

}  // namespace

std::filesystem::path run_directory()
{
    const char* configured = std::getenv("QUORIENT_RUN_DIR");
    return configured ? configured : "/run/quorient";
}

std::optional<Heartbeat> Heartbeat::open(const HeartbeatOwner& owner)
{
    std::error_code ignored;  // open() below tells
    std::filesystem::create_directories(run_directory(), ignored);
    const int file = ::open(file_of(owner).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) return std::nullopt;
    Heartbeat heartbeat{file};
    heartbeat.beat(0, 0);
    const auto whose = fmt::format("{} {}\n{}\n{}\n", owner.domain, owner.unit, owner.service, owner.system);
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

std::vector<Beat> read_heartbeats()
{
    std::vector<Beat> beats;
    std::error_code unreadable;
    for (std::filesystem::directory_iterator entry{run_directory(), unreadable}, end; !unreadable && entry != end; entry.increment(unreadable)) {
        if (entry->path().extension() != extension) continue;
        if (auto beat = read(entry->path())) beats.push_back(std::move(*beat));
    }
    std::ranges::sort(beats, {}, [](const Beat& beat) { return std::tie(beat.owner.service, beat.owner.domain, beat.owner.unit); });
    return beats;
}

}  // namespace quorient::runtime
