#include "quorient/bus/roudi.hpp"

#include "quorient/bus/topics.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <algorithm>
#include <cstring>

namespace quorient::bus {

namespace {

/// Where RouDi 2.0 listens for processes that register.
constexpr const char* roudi_socket = "/tmp/roudi";

/// iceoryx's and Cyclone's headers before each sample, generously.
constexpr std::size_t chunk_header = 256;

constexpr std::size_t pool_granularity = 64;

std::size_t chunk_size(std::size_t sample)
{
    return (sample + chunk_header + pool_granularity - 1) / pool_granularity * pool_granularity;
}

}  // namespace

bool roudi_answers()
{
    const int probe = ::socket(AF_UNIX, SOCK_DGRAM, 0);
    if (probe < 0) return false;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, roudi_socket, sizeof address.sun_path - 1);
    const bool connected = ::connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(probe);
    return connected;
}

std::uint64_t roudi_life()
{
    struct stat socket {};
    if (!roudi_answers() || ::stat(roudi_socket, &socket) != 0) return 0;
    // The inode's number may be given again; the time of its making is not.
    constexpr std::uint64_t second_ns = 1'000'000'000;
    return static_cast<std::uint64_t>(socket.st_ctim.tv_sec) * second_ns + static_cast<std::uint64_t>(socket.st_ctim.tv_nsec);
}

std::string roudi_configuration(std::size_t writers, std::size_t readers)
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
    const std::size_t held = (writers + readers) * depth;
    return fmt::format(
        "[general]\nversion = 1\n[[segment]]\n"
        "[[segment.mempool]]\nsize = {}\ncount = {}\n"
        "[[segment.mempool]]\nsize = {}\ncount = {}\n"
        "[[segment.mempool]]\nsize = 16384\ncount = 64\n",  // Cyclone's own bookkeeping
        chunk_size(hot), held, chunk_size(largest), 4 * (writers + readers));
}

}  // namespace quorient::bus
