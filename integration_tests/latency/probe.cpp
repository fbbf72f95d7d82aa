// Reads the stamps of every voted attitude of one domain and says how long each hop took, and what was lost, doubled or late.

#include "quantiles.hpp"
#include "quorient/bus/bus.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/stamps.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <iostream>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace {

using namespace quorient;

volatile std::sig_atomic_t stopped = 0;

struct Record {
    std::uint32_t unit;
    std::uint32_t voter;
    std::uint64_t sequence;
    std::int64_t arrival_ns;
    Stamps stamp_ns;
};

struct HopName {
    const char* name;
    Hop from;
    Hop to;
};
constexpr std::array hops{
    HopName{"sensor_to_detector", Hop::sensor, Hop::detector_in},
    HopName{"detector", Hop::detector_in, Hop::detector_out},
    HopName{"detector_to_integrator", Hop::detector_out, Hop::integrator_in},
    HopName{"integrator", Hop::integrator_in, Hop::integrator_out},
    HopName{"integrator_to_voter", Hop::integrator_out, Hop::voter_in},
    HopName{"voter", Hop::voter_in, Hop::voter_out},
    HopName{"sensor_to_verdict", Hop::sensor, Hop::detector_out},
    HopName{"sensor_to_attitude", Hop::sensor, Hop::integrator_out},
    HopName{"sensor_to_voted", Hop::sensor, Hop::voter_out},
};

/// @param sent  frames published by the sensors' status, 0 where there is none.
nlohmann::json report(const std::vector<Record>& records, std::uint64_t skipped, double interval_s, std::uint64_t sent)
{
    nlohmann::json result;
    for (const auto& hop : hops) {
        std::vector<std::int64_t> samples;
        for (const auto& record : records) {
            const auto from = record.stamp_ns[static_cast<std::size_t>(hop.from)];
            const auto to = record.stamp_ns[static_cast<std::size_t>(hop.to)];
            if (record.sequence >= skipped && from != 0 && to != 0) samples.push_back(to - from);
        }
        result["hops"][hop.name] = latency::quantiles_us(std::move(samples));
    }
    std::int64_t begin_ns = std::numeric_limits<std::int64_t>::max();
    std::int64_t end_ns = 0;
    // Frames are judged per unit, over both voters: our own subscribers merge them.
    std::map<std::uint32_t, std::set<std::uint64_t>> sequences;
    std::set<std::array<std::uint64_t, 3>> seen;
    std::uint64_t duplicates = 0;
    std::uint64_t late = 0;
    for (const auto& record : records) {
        if (record.sequence < skipped) continue;
        begin_ns = std::min(begin_ns, record.arrival_ns);
        end_ns = std::max(end_ns, record.arrival_ns);
        sequences[record.unit].insert(record.sequence);
        duplicates += seen.insert({record.unit, record.voter, record.sequence}).second ? 0 : 1;
        const auto age = record.stamp_ns[static_cast<std::size_t>(Hop::voter_out)] - record.stamp_ns[static_cast<std::size_t>(Hop::sensor)];
        late += static_cast<double>(age) * 1e-9 > interval_s ? 1 : 0;
    }
    std::uint64_t frames = 0;
    std::uint64_t lost = 0;
    std::uint64_t before = 0;  // the probe found the voters: not theirs to answer for
    for (const auto& [unit, of_unit] : sequences) {
        frames += of_unit.size();
        lost += *of_unit.rbegin() - *of_unit.begin() + 1 - of_unit.size();
        before += *of_unit.begin() - skipped;
    }
    result["frames"] = frames;
    result["lost"] = lost;
    result["before_the_probe"] = before;
    result["duplicates"] = duplicates;
    result["late"] = late;
    result["sent"] = sent;
    result["begin_s"] = static_cast<double>(begin_ns) * 1e-9;
    result["end_s"] = static_cast<double>(end_ns) * 1e-9;
    return result;
}

int run(const bus::Settings& settings, std::uint64_t skipped, double interval_s)
{
    const auto bus = bus::open(settings);
    if (!bus) {
        std::cerr << bus.error() << '\n';
        return 1;
    }
    auto outputs = (*bus)->subscribe(bus::topics::voter_output);
    auto statuses = (*bus)->subscribe(bus::topics::status);
    std::map<std::uint32_t, std::uint64_t> sent_by_unit;
    ServiceStatus status;
    std::vector<Record> records;
    records.reserve(1 << 19);
    VotedAttitude voted;
    while (!stopped) {
        (*bus)->wait(50'000'000);
        while (statuses.take(status)) {
            if (role_of(status) == ServiceRole::sensor) sent_by_unit[status.unit] = status.published;
        }
        while (outputs.take(voted)) {
            // A voter repeats its last attitude where frames end; only frames count.
            if (level_of(voted) == VoteLevel::coasting || level_of(voted) == VoteLevel::lost)
                continue;
            records.push_back(
                {voted.unit, voted.voter, voted.sequence, std::chrono::steady_clock::now().time_since_epoch().count(), voted.stamp_ns});
        }
    }
    std::uint64_t sent = 0;
    for (const auto& [unit, frames] : sent_by_unit) sent += frames;
    std::cout << report(records, skipped, interval_s, sent) << '\n';
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App program{"Reads the stamps of every voted attitude of one domain until SIGTERM, then prints each hop's quantiles as JSON."};
    bus::Settings settings;
    std::string dds = "cyclonedds";
    std::string transport = "udp";
    std::uint64_t skipped = 0;
    double interval_s = 0.005;
    program.add_option("--dds", dds);
    program.add_option("--transport", transport)->check(CLI::IsMember({"udp", "shm", "iceoryx"}));
    program.add_option("--domain", settings.domain);
    program.add_option("--skip", skipped, "Frames of the start that do not count");
    program.add_option("--interval", interval_s, "An attitude older than this at the voter's output is late")->type_name("S");
    CLI11_PARSE(program, argc, argv);
    const auto vendor = bus::vendor_from(dds);
    if (!vendor) {
        std::cerr << vendor.error() << '\n';
        return 2;
    }
    settings.vendor = *vendor;
    settings.transport = bus::transport_from(transport).value();
    std::signal(SIGTERM, [](int) { stopped = 1; });
    return run(settings, skipped, interval_s);
}
