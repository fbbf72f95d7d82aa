#include "roudi.hpp"

#include "quorient/bus/roudi.hpp"
#include "quorient/runtime/heartbeat.hpp"

#include <fmt/format.h>
#include <chrono>
#include <fstream>
#include <thread>

namespace quorient::launch {

namespace {

constexpr auto roudi_patience = std::chrono::seconds{5};
constexpr std::size_t endpoints_each = 8;

std::size_t iceoryx_processes(const system::System& system)
{
    std::size_t count = 0;
    for (const auto* process : system.processes()) count += process->bus.transport == Transport::iceoryx ? 1 : 0;
    return count;
}

}  // namespace

std::string Roudi::start(const system::System& system, Processes& processes)
{
    const auto participants = iceoryx_processes(system);
    if (participants == 0) return {};
    const auto endpoints = participants * endpoints_each;
    const auto refusal = bus::roudi_silence();
    if (!refusal.empty()) {
        const auto needed = bus::roudi_memory(endpoints, endpoints);
        if (bus::free_shared_memory() < needed)
            return fmt::format(
                "iceoryx's daemon needs {} MiB in /dev/shm, {} MiB are free: quorient clean removes what killed processes left",
                needed >> 20, bus::free_shared_memory() >> 20);
        const auto configuration = runtime::run_directory() / "roudi.toml";
        std::ofstream file{configuration};
        file << bus::roudi_configuration(endpoints, endpoints);
        file.close();
        if (!file) return fmt::format("{}: cannot be written; QUORIENT_RUN_DIR chooses another folder", configuration.string());
        processes.add_daemon("roudi", {"/usr/bin/iox-roudi", "-c", configuration.string()},
                             (runtime::run_directory() / "roudi.log").string());
        processes.start();
    }
    const auto deadline = std::chrono::steady_clock::now() + roudi_patience;
    while ((life_ = bus::roudi_life()) == 0) {
        if (std::chrono::steady_clock::now() > deadline)
            return fmt::format("within {} s: {}; the log of the one started here: {}", roudi_patience.count(), bus::roudi_silence(),
                               (runtime::run_directory() / "roudi.log").string());
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    return {};
}

bool Roudi::lost()
{
    if (life_ == 0 || bus::roudi_life() == life_) return false;
    life_ = 0;
    return true;
}

}  // namespace quorient::launch
