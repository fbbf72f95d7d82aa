// One process of the pipeline's graph with an empty algorithm, straight on a vendor's API: the floor of a whole pipeline.
// The same processes, topics, types and arrows; nothing is detected, integrated or compared. With --waits each process waits for what ours
// waits for: an integrator for the frame and its verdict, a voter for the attitude of lane 0, its primary, and a majority.

#include "quorient/bus/settings.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/stamps.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/security/identity.hpp"
#include "raw.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <string>

namespace {

using namespace quorient;
using namespace quorient::latency;

volatile std::sig_atomic_t stopped = 0;

struct Options {
    std::string role;
    std::string dds = "cyclonedds";
    RawSettings raw;
    std::string keys;      ///< directory that `quorient keys` made; empty: plain DDS
    std::string identity;  ///< name in it
    std::uint32_t number = 0;  ///< lane or voter
    std::uint32_t lanes = 3;
    std::uint32_t voters = 2;
    double rate_hz = 200;
    double duration_s = 3;
    bool spin = false;
    bool waits = false;
};

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::int64_t longest_wait_ns = second_ns / 20;

std::int64_t now_ns()
{
    return std::chrono::steady_clock::now().time_since_epoch().count();
}

std::int64_t& stamp(Stamps& stamps, Hop hop)
{
    return stamps[static_cast<std::size_t>(hop)];
}

template <class Message>
void drain(RawReader& reader)
{
    Message unused;
    while (reader.take(&unused)) {
    }
}

/// Goes on until it is stopped, or `round` returns false.
template <class Round>
void loop(Raw& raw, const Options& options, Round round)
{
    while (!stopped && round())
        if (!options.spin) raw.wait(longest_wait_ns);
}

void run_sensor(Raw& raw, const Options& options)
{
    const auto frames = raw.writer(Type::frame, "quorient/frame");
    const auto outputs = raw.reader(Type::voter_output, "quorient/voter_output");
    SensorFrame frame;
    frame.epoch = static_cast<std::uint64_t>(now_ns());
    frame.unit = 1;
    while (!stopped && (frames->matched() < 2 * options.lanes || outputs->matched() < options.voters)) raw.wait(longest_wait_ns / 10);
    const auto interval = static_cast<std::int64_t>(static_cast<double>(second_ns) / options.rate_hz);
    // Voters say nothing of themselves here: half a second for their matches.
    auto due = now_ns() + second_ns / 2;
    const auto end = due + static_cast<std::int64_t>(options.duration_s * static_cast<double>(second_ns));
    while (!stopped && due < end) {
        const auto now = now_ns();
        if (now < due) {
            if (!options.spin) raw.wait(due - now);
            drain<VotedAttitude>(*outputs);
            continue;
        }
        stamp(frame.stamp_ns, Hop::sensor) = now;
        frames->write(&frame);
        ++frame.sequence;
        due += interval;
    }
}

void run_detector(Raw& raw, const Options& options)
{
    const auto verdicts = raw.writer(Type::verdict, "quorient/verdict");
    const auto attitudes = raw.reader(Type::attitude, "quorient/attitude");
    const auto outputs = raw.reader(Type::voter_output, "quorient/voter_output");
    const auto frames = raw.reader(Type::frame, "quorient/frame");
    SensorFrame frame;
    FaultVerdict verdict;
    verdict.detector = options.number;
    loop(raw, options, [&] {
        drain<AttitudeState>(*attitudes);
        drain<VotedAttitude>(*outputs);
        while (frames->take(&frame)) {
            verdict.epoch = frame.epoch;
            verdict.unit = frame.unit;
            verdict.sequence = frame.sequence;
            verdict.stamp_ns = frame.stamp_ns;
            stamp(verdict.stamp_ns, Hop::detector_in) = stamp(verdict.stamp_ns, Hop::detector_out) = now_ns();
            verdicts->write(&verdict);
        }
        return true;
    });
}

void run_integrator(Raw& raw, const Options& options)
{
    const auto attitudes = raw.writer(Type::attitude, "quorient/attitude");
    const auto outputs = raw.reader(Type::voter_output, "quorient/voter_output");
    const auto verdicts = raw.reader(Type::verdict, "quorient/verdict");
    const auto frames = raw.reader(Type::frame, "quorient/frame");
    SensorFrame frame;
    FaultVerdict verdict;
    AttitudeState attitude;
    attitude.lane = options.number;
    std::array<Stamps, 1024> stamps{};  // ring of the verdicts' stamps, by sequence
    std::uint64_t frame_count = 0;
    std::uint64_t verdict_count = 0;
    std::uint64_t answered = 0;
    loop(raw, options, [&] {
        drain<VotedAttitude>(*outputs);
        while (verdicts->take(&verdict)) {
            if (verdict.detector != options.number) continue;
            verdict_count = verdict.sequence + 1;
            stamps[verdict.sequence % stamps.size()] = verdict.stamp_ns;
        }
        while (frames->take(&frame)) frame_count = frame.sequence + 1;
        for (const auto ready = options.waits ? std::min(frame_count, verdict_count) : verdict_count; answered < ready; ++answered) {
            attitude.epoch = verdict.epoch;
            attitude.unit = verdict.unit;
            attitude.sequence = answered;
            attitude.stamp_ns = stamps[answered % stamps.size()];
            stamp(attitude.stamp_ns, Hop::integrator_in) = stamp(attitude.stamp_ns, Hop::integrator_out) = now_ns();
            attitudes->write(&attitude);
        }
        return true;
    });
}

void run_voter(Raw& raw, const Options& options)
{
    const auto outputs = raw.writer(Type::voter_output, "quorient/voter_output");
    const auto others = raw.reader(Type::voter_output, "quorient/voter_output");
    const auto verdicts = raw.reader(Type::verdict, "quorient/verdict");
    const auto attitudes = raw.reader(Type::attitude, "quorient/attitude");
    std::array<std::uint64_t, 1024> seen{};  // lanes by sequence, as a ring
    AttitudeState attitude;
    VotedAttitude voted;
    voted.voter = options.number;
    const int majority = static_cast<int>(options.lanes) / 2 + 1;
    loop(raw, options, [&] {
        drain<VotedAttitude>(*others);
        drain<FaultVerdict>(*verdicts);
        while (attitudes->take(&attitude)) {
            auto& lanes = seen[attitude.sequence % seen.size()];
            seen[(attitude.sequence + seen.size() / 2) % seen.size()] = 0;
            lanes |= std::uint64_t{1} << attitude.lane;
            constexpr std::uint64_t out_already = std::uint64_t{1} << 63U;
            const bool primary_speaks = !options.waits || (lanes & 1U) != 0;
            if ((lanes & out_already) != 0 || std::popcount(lanes) < majority || !primary_speaks) continue;
            lanes |= out_already;
            voted.epoch = attitude.epoch;
            voted.unit = attitude.unit;
            voted.sequence = attitude.sequence;
            voted.stamp_ns = attitude.stamp_ns;
            stamp(voted.stamp_ns, Hop::voter_in) = stamp(voted.stamp_ns, Hop::voter_out) = now_ns();
            outputs->write(&voted);
        }
        return true;
    });
}

/// The files that this process joins with, in the domain and at the level of their directory.
void secure(Options& options)
{
    const auto governance = security::find_governance(options.keys);
    if (!governance) throw std::runtime_error(governance.error());
    options.raw.domain = governance->domain;
    const security::Joining joining{options.identity, bus::vendor_from(options.dds).value(), governance->domain, governance->level};
    auto identity = security::find_identity(options.keys, joining, std::time(nullptr));
    if (!identity) throw std::runtime_error(identity.error().front());
    options.raw.security = std::move(identity->files);
}

int run(const Options& options)
{
    const auto raw = options.dds == "fastdds" ? open_raw_fastdds(options.raw) : open_raw_cyclonedds(options.raw);
    if (options.role == "sensor") run_sensor(*raw, options);
    else if (options.role == "detector") run_detector(*raw, options);
    else if (options.role == "integrator") run_integrator(*raw, options);
    else run_voter(*raw, options);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App program{"One process of the pipeline's graph with an empty algorithm, straight on a vendor's API."};
    Options options;
    program.add_option("role", options.role)->required()->check(CLI::IsMember({"sensor", "detector", "integrator", "voter"}));
    program.add_option("--dds", options.dds)->check(CLI::IsMember({"fastdds", "cyclonedds"}));
    program.add_option("--domain", options.raw.domain);
    program.add_option("--keys", options.keys, "Joins under DDS Security, in the domain of the keys");
    program.add_option("--as", options.identity, "Identity of --keys");
    program.add_flag("--shared-memory", options.raw.shared_memory);
    program.add_option("--number", options.number, "Of the lane or voter");
    program.add_option("--lanes", options.lanes);
    program.add_option("--voters", options.voters);
    program.add_option("--rate", options.rate_hz)->type_name("HZ");
    program.add_option("--duration", options.duration_s)->type_name("S");
    program.add_flag("--spin", options.spin);
    program.add_flag("--waits", options.waits, "For all that our processes wait for");
    CLI11_PARSE(program, argc, argv);
    std::signal(SIGTERM, [](int) { stopped = 1; });
    try {
        if (!options.keys.empty()) secure(options);
        return run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
