#include "quorient/bus/iceoryx_guard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iceoryx_hoofs/error_handling/error_handling.hpp>
#include <iceoryx_posh/internal/runtime/ipc_interface_creator.hpp>
#include <iceoryx_posh/internal/runtime/ipc_interface_user.hpp>
#include <iceoryx_posh/version/version_info.hpp>

namespace quorient::bus {

namespace {

constexpr const char* management_memory = "/dev/shm/iceoryx_mgmt";

iox::units::Duration patience()
{
    return iox::units::Duration::fromMilliseconds(700);
}

/// Registration as iceoryx 2.0 does it: name, process, user, a time and the version [iceoryx_posh, ipc_runtime_interface.cpp].
bool registers(const std::string& name)
{
    using namespace iox::runtime;
    const iox::RuntimeName_t runtime_name{iox::cxx::TruncateToCapacity, name};
    IpcInterfaceCreator own{runtime_name};
    IpcInterfaceUser daemon{iox::roudi::IPC_CHANNEL_ROUDI_NAME};
    if (!own.isInitialized() || !daemon.isInitialized()) return false;
    IpcMessage request;
    request << IpcMessageTypeToString(IpcMessageType::REG) << name << ::getpid() << ::geteuid() << 0
            << static_cast<iox::cxx::Serialization>(iox::version::VersionInfo::getCurrentVersion()).toString();
    IpcMessage answer;
    if (!daemon.timedSend(request, patience()) || !own.timedReceive(patience(), answer)) return false;
    if (answer.getElementAtIndex(0) != IpcMessageTypeToString(IpcMessageType::REG_ACK)) return false;
    IpcMessage leave;
    leave << IpcMessageTypeToString(IpcMessageType::TERMINATION) << name;
    return daemon.timedSend(leave, patience()) && own.timedReceive(patience(), answer);
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
    if (registers(unused_name())) return {};
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
