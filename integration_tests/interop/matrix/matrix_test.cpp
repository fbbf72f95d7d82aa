// {our bus on either vendor} x {a plain node of either vendor} x {it publishes, it subscribes} x qualities of service, by the wire on
// loopback, in the manner of the OMG's dds-rtps tests. The table MATRIX.md is this test's own output:
// QUORIENT_WRITE_MATRIX=integration_tests/interop/MATRIX.md interop_matrix_test

#include "foreign.hpp"
#include "quorient/bus/bus.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <list>
#include <map>
#include <sstream>
#include <vector>

namespace quorient::bus {

namespace {

using foreign::Sample;
using foreign::Wish;
using SteadyClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds patience{10'000};

/// Best effort may lose samples on a busy machine, which is no error: so many bursts are sent until one arrives whole.
constexpr std::uint64_t best_effort_bursts = 10;
constexpr std::chrono::milliseconds patience_for_a_burst{1000};

enum class Case { plain, late, late_volatile, instances, late_instances, silent, other_domain };

/// One row of the table. `expected` is what every column must show: one of the answers that " or " separates.
struct Scenario {
    const char* name;
    Wish writer;
    Wish reader;
    Case kind;
    const char* expected;
};

const std::vector<Scenario> scenarios{
    {"reliable writer, reliable reader", {}, {}, Case::plain, "delivers"},
    {"reliable writer, best-effort reader", {}, {.reliable = false}, Case::plain, "delivers"},
    {"best-effort writer, best-effort reader", {.reliable = false}, {.reliable = false}, Case::plain, "delivers"},
    {"best-effort writer, reliable reader", {.reliable = false}, {}, Case::plain, "incompatible: RELIABILITY"},
    {"transient-local, late joiner", {.transient_local = true}, {.transient_local = true}, Case::late, "delivers the history"},
    {"transient-local writer, volatile late joiner", {.transient_local = true}, {}, Case::late_volatile, "delivers"},
    {"volatile writer, transient-local reader", {}, {.transient_local = true}, Case::plain, "incompatible: DURABILITY"},
    {"exclusive writer, exclusive reader", {.exclusive = true}, {.exclusive = true}, Case::plain, "delivers"},
    // 50 ms as the wire's binary fraction and back, rounded down: 214748364 / 2^32 s.
    {"exclusive writer, exclusive reader that asks for the stated lease, rounded down",
     {.exclusive = true},
     {.exclusive = true, .reader_lease_ns = 49'999'999},
     Case::plain,
     "delivers"},
    {"exclusive writer, shared reader", {.exclusive = true}, {}, Case::plain, "incompatible: OWNERSHIP"},
    // Our exclusive reader on Fast DDS asks for liveliness MANUAL_BY_TOPIC too; which of the two is reported is the vendor's choice.
    {"shared writer, exclusive reader", {}, {.exclusive = true}, Case::plain, "incompatible: OWNERSHIP or incompatible: LIVELINESS"},
    {"keyed instances", {}, {}, Case::instances, "delivers"},
    {"keyed instances, transient-local, depth 2, late joiner",
     {.transient_local = true, .depth = 2},
     {.transient_local = true},
     Case::late_instances,
     "delivers the history"},
    // By the standard a different partition is silent. Cyclone DDS reports it all the same.
    {"the foreign node in another partition", {}, {}, Case::silent, "no match or incompatible: PARTITION"},
    {"the foreign node with another type name", {}, {}, Case::silent, "no match"},
    {"the foreign node in another domain", {}, {}, Case::other_domain, "no match"},
};

/// Either side of a cell as the test sees it.
struct Side {
    std::function<std::uint32_t()> matched;
    std::function<bool(const Sample&)> write{};
    std::function<bool(Sample&)> take{};
};

Qos ours(const Wish& wish)
{
    return {.reliable = wish.reliable, .transient_local = wish.transient_local, .depth = wish.depth, .exclusive = wish.exclusive};
}

/// Participants are made once per pair; every cell has a topic of its own.
class Pair {
public:
    Pair(Vendor our_vendor, Vendor foreign_vendor, std::uint32_t domain) : our_vendor_(our_vendor), foreign_vendor_(foreign_vendor)
    {
        Settings settings;
        settings.vendor = our_vendor;
        settings.domain = domain;
        settings.participant = "matrix";
        auto opened = open(settings);
        if (!opened) throw Error(opened.error());
        bus_ = std::move(*opened);
        foreign_ = node(domain);
        elsewhere_ = node(domain + 1);
    }

    /// @returns what happened, as it stands in the table.
    std::string run(const Scenario& scenario, bool foreign_publishes)
    {
        name_ = &names_.emplace_back(fmt::format("interop/{}", names_.size()));
        auto theirs = foreign_publishes ? scenario.writer : scenario.reader;
        if (scenario.kind == Case::silent && std::string_view{scenario.name}.ends_with("partition")) theirs.partition = "elsewhere";
        if (scenario.kind == Case::silent && std::string_view{scenario.name}.ends_with("name")) theirs.other_type = true;
        auto& their_node = scenario.kind == Case::other_domain ? *elsewhere_ : *foreign_;
        const bool late = scenario.kind == Case::late || scenario.kind == Case::late_volatile || scenario.kind == Case::late_instances;

        std::unique_ptr<foreign::Endpoint> endpoint;
        const auto make_theirs = [&] {
            endpoint = foreign_publishes ? their_node.writer(*name_, theirs) : their_node.reader(*name_, theirs);
            return Side{[&] { return endpoint->matched(); }, [&](const Sample& s) { return endpoint->write(s); },
                        [&](Sample& s) { return endpoint->take(s); }};
        };
        publisher_.reset();
        subscription_.reset();
        Side writing, reading;
        (foreign_publishes ? writing : reading) = foreign_publishes || !late ? make_theirs() : Side{};
        if (!foreign_publishes) writing = make_our_writer(scenario.writer);
        else if (!late) reading = make_our_reader(scenario.reader);
        if (late) {
            send(writing, scenario.kind == Case::late_instances ? 5 : 1, 0, 10);
            reading = foreign_publishes ? make_our_reader(scenario.reader) : make_theirs();
        }
        if (scenario.kind == Case::silent || scenario.kind == Case::other_domain) return silence(scenario.kind == Case::silent);
        return exchange(scenario, writing, reading);
    }

private:
    std::unique_ptr<foreign::Node> node(std::uint32_t domain) const
    {
        return foreign_vendor_ == Vendor::fastdds ? foreign::plain_fastdds(domain) : foreign::plain_cyclonedds(domain);
    }

    Side make_our_writer(const Wish& wish)
    {
        const Topic<VotedAttitude> topic{name_->c_str(), TypeId::voted_attitude, ours(wish)};
        publisher_.emplace(bus_->advertise(topic, {.strength = 1, .lease_s = 0.05}));
        const auto write = [this](const Sample& sample) {
            VotedAttitude message;
            message.unit = sample.unit;
            message.sequence = sample.sequence;
            return publisher_->publish(message);
        };
        return {[this] { return publisher_->status().matched; }, write, {}};
    }

    Side make_our_reader(const Wish& wish)
    {
        const Topic<VotedAttitude> topic{name_->c_str(), TypeId::voted_attitude, ours(wish)};
        subscription_.emplace(bus_->subscribe(topic));
        const auto take = [this](Sample& sample) {
            VotedAttitude message;
            if (!subscription_->take(message)) return false;
            sample = {message.unit, message.sequence};
            return true;
        };
        return {[this] { return subscription_->status().matched; }, {}, take};
    }

    EndpointStatus our_status() { return publisher_ ? publisher_->status() : subscription_->status(); }

    template <class Condition>
    bool eventually(Condition condition, std::chrono::milliseconds within = patience)
    {
        const auto deadline = SteadyClock::now() + within;
        while (!condition()) {
            if (SteadyClock::now() > deadline) return false;
            bus_->wait(2'000'000);
        }
        return true;
    }

    static void send(const Side& writing, std::uint32_t units, std::uint64_t from, std::uint64_t count)
    {
        for (std::uint64_t sequence = from; sequence < from + count; ++sequence) {
            for (std::uint32_t unit = 0; unit < units; ++unit) writing.write({unit, sequence});
        }
    }

    /// A control topic that does match shows that discovery has processed what was announced before it.
    std::string silence(bool with_control)
    {
        if (with_control) {
            const Topic<VotedAttitude> control{names_.emplace_back(*name_ + "_control").c_str(), TypeId::voted_attitude, {}};
            auto control_reader = bus_->subscribe(control);
            const auto control_writer = foreign_->writer(control.spec.name, {});
            const auto matched = [&] { return control_reader.status().matched > 0 && control_writer->matched() > 0; };
            if (!eventually(matched)) return "the control did not match";
        } else {
            const auto until = SteadyClock::now() + std::chrono::milliseconds{300};
            while (SteadyClock::now() < until) bus_->wait(2'000'000);
        }
        const auto status = our_status();
        if (status.incompatible > 0) return fmt::format("incompatible: {}", status.policy);
        return status.matched == 0 ? "no match" : "matches";
    }

    std::string exchange(const Scenario& scenario, const Side& writing, const Side& reading)
    {
        const auto settled = [&] { return our_status().incompatible > 0 || (writing.matched() > 0 && reading.matched() > 0); };
        if (!eventually(settled)) return "no match";
        if (our_status().incompatible > 0) return fmt::format("incompatible: {}", our_status().policy);

        const std::uint32_t units = scenario.kind == Case::instances || scenario.kind == Case::late_instances ? 5 : 1;
        const bool history = scenario.kind == Case::late || scenario.kind == Case::late_instances;
        if (!history && !warm_up(writing, reading)) return "matches, delivers nothing";
        const std::uint64_t first = history ? scenario.kind == Case::late_instances ? 8 : 0 : present;
        const std::uint64_t count = scenario.kind == Case::late_instances ? 2 : 10;
        if (history) return judge(reading, units, first, count, "delivers the history", patience);
        const bool may_lose = !scenario.writer.reliable || !scenario.reader.reliable;
        std::string result;
        for (std::uint64_t burst = 0; burst < (may_lose ? best_effort_bursts : 1) && result != "delivers"; ++burst) {
            send(writing, units, first + burst * count, count);
            result = judge(reading, units, first + burst * count, count, "delivers", may_lose ? patience_for_a_burst : patience);
        }
        return result;
    }

    /// Both sides report a match shortly before the match is complete. A volatile reader may miss samples until then, which is no error.
    bool warm_up(const Side& writing, const Side& reading)
    {
        Sample sample;
        return eventually([&] {
            writing.write({0, warming});
            bus_->wait(20'000'000);
            return reading.take(sample) && sample.sequence == warming;
        });
    }

    /// Exactly these samples of every unit, in order, among what was sent for the purpose.
    std::string judge(const Side& reading, std::uint32_t units, std::uint64_t first, std::uint64_t count, const char* success,
                      std::chrono::milliseconds within)
    {
        std::map<std::uint32_t, std::vector<std::uint64_t>> got;
        const auto complete = [&] {
            Sample sample;
            std::size_t samples = 0;
            while (reading.take(sample)) {
                if (sample.sequence >= first && sample.sequence != warming) got[sample.unit].push_back(sample.sequence);
            }
            for (const auto& [unit, sequences] : got) samples += sequences.size();
            return samples >= units * count;
        };
        if (!eventually(complete, within)) return fmt::format("delivers too little: {} instances", got.size());
        for (const auto& [unit, sequences] : got) {
            for (std::size_t i = 0; i < sequences.size(); ++i) {
                if (sequences.size() != count || sequences[i] != first + i) return fmt::format("unit {}: other samples than meant", unit);
            }
        }
        return success;
    }

    static constexpr std::uint64_t warming = 99;   ///< sequence of the samples before the ones that count
    static constexpr std::uint64_t present = 100;  ///< first sequence of these; history is 0 to 9

    Vendor our_vendor_;
    Vendor foreign_vendor_;
    std::unique_ptr<Bus> bus_;
    std::unique_ptr<foreign::Node> foreign_;
    std::unique_ptr<foreign::Node> elsewhere_;
    std::list<std::string> names_;
    const std::string* name_ = nullptr;
    std::optional<Publisher<VotedAttitude>> publisher_;
    std::optional<Subscription<VotedAttitude>> subscription_;
};

std::string table(const std::map<std::string, std::vector<std::string>>& rows)
{
    std::string text =
        "# Interoperation on loopback\n\nGenerated by `interop_matrix_test`; the ordinary test run compares. \"Fast <- Cyclone\": our bus "
        "on Fast DDS "
        "reads what a plain Cyclone DDS\nnode writes; \"->\": it writes, the plain node reads. Debian 12: Fast DDS 2.9.1, Cyclone DDS "
        "0.10.2. \"incompatible: X\" is what our side reports\n(`EndpointStatus`, and as an event); \"no match\" is silent by the "
        "standard, "
        "and the services' watchdog reports it after 5 s.\n\n| | Fast <- Fast | Fast -> Fast | Fast <- Cyclone | Fast -> Cyclone | "
        "Cyclone <- Fast | Cyclone -> Fast | Cyclone <- Cyclone | Cyclone -> Cyclone |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const auto& scenario : scenarios) {
        text += fmt::format("| {} |", scenario.name);
        for (const auto& cell : rows.at(scenario.name)) text += fmt::format(" {} |", cell);
        text += '\n';
    }
    return text;
}

bool is_expected(const std::string& result, std::string_view expected)
{
    for (;;) {
        const auto end = expected.find(" or ");
        if (result == expected.substr(0, end)) return true;
        if (end == std::string_view::npos) return false;
        expected.remove_prefix(end + 4);
    }
}

TEST(Matrix, every_cell_is_as_the_standard_has_it_and_as_the_table_says)
{
    foreign::fastdds_by_the_wire();
    const char* wanted = std::getenv("QUORIENT_INTEROP_DOMAIN");
    std::uint32_t domain = wanted ? static_cast<std::uint32_t>(std::atoi(wanted)) : 120 + static_cast<std::uint32_t>(::getpid() % 90);
    std::map<std::string, std::vector<std::string>> rows;
    for (const auto our : {Vendor::fastdds, Vendor::cyclonedds}) {
        for (const auto their : {Vendor::fastdds, Vendor::cyclonedds}) {
            Pair pair{our, their, domain};
            domain += 2;
            for (const auto& scenario : scenarios) {
                for (const bool foreign_publishes : {true, false}) {
                    const auto result = pair.run(scenario, foreign_publishes);
                    EXPECT_TRUE(is_expected(result, scenario.expected))
                        << result << ", not " << scenario.expected << ": " << scenario.name << ": ours on " << to_string(our) << ", plain "
                        << to_string(their) << (foreign_publishes ? " publishes" : " subscribes");
                    rows[scenario.name].push_back(result);
                }
            }
        }
    }
    const auto generated = table(rows);
    if (const char* file = std::getenv("QUORIENT_WRITE_MATRIX")) std::ofstream{file} << generated;
    std::ifstream file{QUORIENT_SOURCE_DIR "/integration_tests/interop/MATRIX.md"};
    std::stringstream committed;
    committed << file.rdbuf();
    EXPECT_EQ(committed.str(), generated);
}

}  // namespace

}  // namespace quorient::bus
