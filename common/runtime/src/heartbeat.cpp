#include "quorient/runtime/heartbeat.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace quorient::runtime {

namespace {

std::filesystem::path file_of(const std::string& service)
{
    return run_directory() / (service + ".heartbeat");
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
    const int file = ::open(file_of(service).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) return std::nullopt;
    return Heartbeat{file};
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
    std::array<char, 64> line{};  // fixed width: an in-place rewrite never leaves a tail
    const int length = std::snprintf(line.data(), line.size(), "%20" PRId64 " %20" PRIu64 "\n", steady_ns, frames);
    if (::pwrite(file_, line.data(), static_cast<std::size_t>(length), 0) < 0) return;  // a full disk must not stop a service
}

std::optional<Beat> read_heartbeat(const std::string& service)
{
    std::ifstream file{file_of(service)};
    Beat beat;
    if (!(file >> beat.steady_ns >> beat.frames)) return std::nullopt;
    return beat;
}

}  // namespace quorient::runtime
