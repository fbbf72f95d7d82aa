#include "quorient/bus/roudi.hpp"

#include "quorient/bus/topics.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

namespace quorient::bus {

namespace {

/// Where RouDi 2.0 listens for processes that register.
constexpr const char* roudi_socket = "/tmp/roudi";

constexpr const char* shared_memory_folder = "/dev/shm";

/// iceoryx's and Cyclone's headers before each sample, generously.
constexpr std::size_t chunk_header = 256;

constexpr std::size_t pool_granularity = 64;

/// RouDi 2.0.3's own book-keeping of ports and queues, as Debian builds it.
constexpr std::uintmax_t management_memory = 66'200'000;

struct Pool {
    std::size_t size;
    std::size_t count;
};

std::array<Pool, 3> pools_for(std::size_t writers, std::size_t readers)
{
    std::size_t hot = 0;
    std::size_t largest = 0;
    std::size_t depth = 0;
    const auto look = [&](const TopicSpec& topic) {
        largest = std::max(largest, topic.size);
        depth = std::max(depth, static_cast<std::size_t>(std::min(topic.qos.depth, 64)));
        if (topic.type != TypeId::cluster_description) hot = std::max(hot, topic.size);
    };
    std::apply([&](const auto&... topic) { (look(topic.spec), ...); }, topics::all);
    constexpr Pool bookkeeping_of_cyclonedds{16384, 64};
    return {Pool{chunk_size(hot), (writers + readers) * depth}, Pool{chunk_size(largest), 4 * (writers + readers)},
            bookkeeping_of_cyclonedds};
}

/// @returns 0 when the daemon's socket takes messages from this user, else errno.
int knock()
{
    const int probe = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (probe < 0) return errno;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, roudi_socket, sizeof address.sun_path - 1);
    const int refused = ::connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
    ::close(probe);
    return refused;
}

std::string owner_of(const char* path)
{
    struct stat status {};
    if (::stat(path, &status) != 0) return "another user";
    const auto* user = ::getpwuid(status.st_uid);
    return user ? user->pw_name : fmt::format("user {}", status.st_uid);
}

}  // namespace

std::size_t chunk_size(std::size_t sample)
{
    return (sample + chunk_header + pool_granularity - 1) / pool_granularity * pool_granularity;
}

bool roudi_answers()
{
    return knock() == 0;
}

std::string roudi_silence()
{
    const int refused = knock();
    if (refused == 0) return {};
    if (refused == EACCES || refused == EPERM)
        return fmt::format(
            "iceoryx's daemon iox-roudi belongs to {} and lets this user not in: run both as one user, or use transport udp, or "
            "shared_memory: preferred",
            owner_of(roudi_socket));
    return "iceoryx's daemon iox-roudi does not answer: start it (quorient launch does), or use transport udp, or shared_memory: preferred";
}

std::uint64_t roudi_life()
{
    struct stat socket {};
    if (!roudi_answers() || ::stat(roudi_socket, &socket) != 0) return 0;
    // The inode's number may be reused; its creation time is not.
    constexpr std::uint64_t second_ns = 1'000'000'000;
    return static_cast<std::uint64_t>(socket.st_ctim.tv_sec) * second_ns + static_cast<std::uint64_t>(socket.st_ctim.tv_nsec);
}

std::array<std::uint64_t, 2> roudi_identity()
{
    std::string boot;
    std::getline(std::ifstream{"/proc/sys/kernel/random/boot_id"}, boot);
    return {std::hash<std::string>{}(boot), roudi_life()};
}

std::string roudi_configuration(std::size_t writers, std::size_t readers)
{
    std::string configuration = "[general]\nversion = 1\n[[segment]]\n";
    for (const auto& pool : pools_for(writers, readers))
        configuration += fmt::format("[[segment.mempool]]\nsize = {}\ncount = {}\n", pool.size, pool.count);
    return configuration;
}

std::uintmax_t roudi_memory(std::size_t writers, std::size_t readers)
{
    std::uintmax_t bytes = management_memory;
    for (const auto& pool : pools_for(writers, readers)) bytes += pool.count * (pool.size + pool_granularity);
    return bytes;
}

std::uintmax_t free_shared_memory()
{
    std::error_code unknown;
    const auto space = std::filesystem::space(shared_memory_folder, unknown);
    return unknown ? 0 : space.available;
}

}  // namespace quorient::bus
