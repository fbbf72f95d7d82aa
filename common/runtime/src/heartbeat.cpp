#include "quorient/runtime/heartbeat.hpp"

#include "quorient/runtime/heartbeat_owner.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>

namespace quorient::runtime {

namespace {

constexpr const char* extension = ".heartbeat";
constexpr std::size_t sum_length = 8;  // hexadecimal digits
// A beat is written within microseconds, unless its writer is kept from running in the middle of it.
constexpr int most_reads = 50;
constexpr auto between_reads = std::chrono::milliseconds{1};

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

/// The whole file: the beat; domain and unit, service, system, whose names may hold blanks but no line ends; the sum of all these.
std::string unsigned_beat(const std::string& service)
{
    return fmt::format("{:>20} {:>20}\n{} {}\n{}\n{}\n{:>{}}\n", 0, 0, owner().domain, owner().unit, service, owner().system, "", sum_length);
}

/// FNV-1a of 32 bits: a beat that is part old and part new has another sum.
std::uint32_t sum_of(std::string_view text)
{
    std::uint32_t sum = 2'166'136'261;
    for (const char letter : text) sum = (sum ^ static_cast<unsigned char>(letter)) * 16'777'619;
    return sum;
}

std::string_view without_sum(std::string_view text)
{
    return text.substr(0, text.size() - sum_length - 1);
}

/// Whether the text was read between two writes. The files of an earlier release have four lines and no sum.
bool is_whole(std::string_view text)
{
    if (std::ranges::count(text, '\n') != 5 || text.size() <= sum_length) return true;
    return text.substr(text.size() - sum_length - 1, sum_length) == fmt::format("{:0{}x}", sum_of(without_sum(text)), sum_length);
}

std::optional<std::string> read_whole(const std::filesystem::path& path)
{
    for (int read = 0; read < most_reads; ++read) {
        std::ifstream file{path};
        std::string text{std::istreambuf_iterator<char>(file), {}};
        if (is_whole(text)) return text;
        std::this_thread::sleep_for(between_reads);
    }
    return std::nullopt;
}

std::optional<Pulse> read_pulse(const std::filesystem::path& path)
{
    const auto text = read_whole(path);
    if (!text) return std::nullopt;
    std::istringstream file{*text};
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
    std::error_code ignored;  // open() below reports it
    std::filesystem::create_directories(run_directory(), ignored);
    const int file = ::open(file_of(stem_of(service)).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0) return std::nullopt;
    Heartbeat heartbeat{file, unsigned_beat(service)};
    heartbeat.beat(0, 0);
    // Only now: until here a reader finds what the process before this one left, and never an empty file.
    if (::ftruncate(file, static_cast<off_t>(heartbeat.text_.size())) < 0) return std::nullopt;
    return heartbeat;
}

Heartbeat::~Heartbeat()
{
    if (file_ >= 0) ::close(file_);
}

Heartbeat::Heartbeat(Heartbeat&& other) noexcept : file_(std::exchange(other.file_, -1)), text_(std::move(other.text_)) {}

Heartbeat& Heartbeat::operator=(Heartbeat&& other) noexcept
{
    std::swap(file_, other.file_);
    std::swap(text_, other.text_);
    return *this;
}

void Heartbeat::beat(std::int64_t steady_ns, std::uint64_t frames)
{
    fmt::format_to(text_.begin(), "{:>20} {:>20}", steady_ns, frames);
    fmt::format_to(text_.end() - sum_length - 1, "{:0{}x}", sum_of(without_sum(text_)), sum_length);
    if (::pwrite(file_, text_.data(), text_.size(), 0) < 0) return;  // a full disk must not stop a service
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
