#include "quorient/bus/iceoryx_guard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iceoryx_hoofs/error_handling/error_handling.hpp>
#include <iceoryx_hoofs/platform/platform_settings.hpp>
#include <iceoryx_posh/internal/runtime/ipc_interface_user.hpp>
#include <iceoryx_posh/version/version_info.hpp>
#include <optional>

namespace quorient::bus {

namespace {

constexpr const char* management_memory = "/dev/shm/iceoryx_mgmt";

iox::units::Duration patience()
{
    return iox::units::Duration::fromMilliseconds(700);
}

/// A socket under this name in the folder where iceoryx looks for its processes, for as long as it lives.
class ReplySocket {
public:
    explicit ReplySocket(const std::string& name)
        : file_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)), path_(iox::platform::IOX_UDS_SOCKET_PATH_PREFIX + name)
    {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
        const int on = 1;
        const auto limit_us = patience().toMicroseconds();
        const timeval limit{static_cast<time_t>(limit_us / 1'000'000), static_cast<suseconds_t>(limit_us % 1'000'000)};
        good_ = file_ >= 0 && ::bind(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                ::setsockopt(file_, SOL_SOCKET, SO_PASSCRED, &on, sizeof on) == 0 &&
                ::setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit) == 0;
    }
    ReplySocket(const ReplySocket&) = delete;
    ReplySocket& operator=(const ReplySocket&) = delete;
    ~ReplySocket()
    {
        if (file_ >= 0) ::close(file_);
        ::unlink(path_.c_str());
    }

    bool is_good() const { return good_; }

    struct Reply {
        iox::runtime::IpcMessage message;
        pid_t sender = 0;  ///< as this process sees it; 0 where it cannot
    };

    std::optional<Reply> receive() const
    {
        std::array<char, 4096> text{};
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> control{};
        iovec part{text.data(), text.size() - 1};
        msghdr header{};
        header.msg_iov = &part;
        header.msg_iovlen = 1;
        header.msg_control = control.data();
        header.msg_controllen = control.size();
        if (::recvmsg(file_, &header, 0) <= 0) return std::nullopt;
        Reply reply;
        reply.message.setMessage(text.data());
        const auto* credentials = CMSG_FIRSTHDR(&header);
        if (credentials && credentials->cmsg_type == SCM_CREDENTIALS) {
            ucred sender{};
            std::memcpy(&sender, CMSG_DATA(credentials), sizeof sender);
            reply.sender = sender.pid;
        }
        return reply;
    }

private:
    int file_;
    std::string path_;
    bool good_ = false;
};

/// iceoryx's locks in shared memory know a thread by its number, which is unique within one namespace of process ids alone: two threads of one
/// number hold such a lock at once.
bool shares_process_ids(pid_t other)
{
    if (other == 0) return false;  // in a namespace that is not part of ours
    std::error_code unreadable;
    const auto theirs = std::filesystem::read_symlink(fmt::format("/proc/{}/ns/pid", other), unreadable);
    const auto own = std::filesystem::read_symlink("/proc/self/ns/pid", unreadable);
    return unreadable || theirs == own;
}

enum class Answer { none, accepted, from_other_process_ids };

/// Registration as iceoryx 2.0 does it: name, process, user, a time and the version [iceoryx_posh, ipc_runtime_interface.cpp].
Answer registers(const std::string& name)
{
    using namespace iox::runtime;
    const ReplySocket own{name};
    IpcInterfaceUser daemon{iox::roudi::IPC_CHANNEL_ROUDI_NAME};
    if (!own.is_good() || !daemon.isInitialized()) return Answer::none;
    IpcMessage request;
    request << IpcMessageTypeToString(IpcMessageType::REG) << name << ::getpid() << ::geteuid() << 0
            << static_cast<iox::cxx::Serialization>(iox::version::VersionInfo::getCurrentVersion()).toString();
    if (!daemon.timedSend(request, patience())) return Answer::none;
    const auto reply = own.receive();
    if (!reply || reply->message.getElementAtIndex(0) != IpcMessageTypeToString(IpcMessageType::REG_ACK)) return Answer::none;
    IpcMessage leave;
    leave << IpcMessageTypeToString(IpcMessageType::TERMINATION) << name;
    if (!daemon.timedSend(leave, patience()) || !own.receive()) return Answer::none;
    return shares_process_ids(reply->sender) ? Answer::accepted : Answer::from_other_process_ids;
}

/// Processes of several containers may share RouDi, and have the same id.
std::string unused_name()
{
    return fmt::format("iceoryx_rt_probe_{}_{}", ::getpid(), std::chrono::system_clock::now().time_since_epoch().count());
}

void handle(const iox::Error error, const std::function<void()>& callback, const iox::ErrorLevel level)
{
    if (error == iox::Error::kMEPOO__MEMPOOL_GETCHUNK_CHUNK_IS_TOO_LARGE ||
        error == iox::Error::kMEPOO__MEMPOOL_GETCHUNK_POOL_IS_RUNNING_OUT_OF_CHUNKS)
        return;
    fmt::print(stderr, "iceoryx: {}\n", iox::ErrorHandler::toString(error));
    if (callback) callback();
    if (level != iox::ErrorLevel::MODERATE) std::abort();  // as iceoryx's own handler does
}

}  // namespace

std::string iceoryx_refusal()
{
    const int memory = ::open(management_memory, O_RDWR | O_CLOEXEC);
    if (memory < 0 && (errno == EACCES || errno == EPERM))
        return fmt::format(
            "this user may not open the memory of iceoryx's daemon, {}: run both as one user, or use transport udp, or "
            "shared_memory: preferred",
            management_memory);
    if (memory >= 0) ::close(memory);
    const auto answer = registers(unused_name());
    if (answer == Answer::accepted) return {};
    if (answer == Answer::from_other_process_ids)
        return "iceoryx's daemon iox-roudi runs in another namespace of process ids, where its locks in shared memory do not exclude each other: "
               "let both share one (docker: pid: \"service:roudi\"), or use transport udp, or shared_memory: preferred";
    return fmt::format(
        "iceoryx's daemon iox-roudi is there, but does not take this process in: is it of another version than {}, or stopped? "
        "Start it again, or use transport udp, or shared_memory: preferred",
        ICEORYX_LATEST_RELEASE_VERSION);
}

void survive_full_pools()
{
    static const auto kept_for_good = iox::ErrorHandler::setTemporaryErrorHandler(handle);
}

}  // namespace quorient::bus
