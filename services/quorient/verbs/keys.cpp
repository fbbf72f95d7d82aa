#include "cli/program.hpp"
#include "cli/system_options.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/runtime/clock.hpp"
#include "quorient/security/authority.hpp"
#include "quorient/system/members.hpp"
#include "verbs.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <memory>

namespace quorient::cli {

namespace {

using security::Authority;
using security::IssuedIdentity;
using security::Member;
using security::Role;

constexpr double day_s = 86'400;

struct KeysOptions {
    SystemOptions system;
    std::string out;
    std::string add;
    std::string role;
    std::vector<std::string> publish, subscribe;
    std::vector<std::string> renew, revoke;
    double days = 365;
};

template <class Value>
Value or_fail(tl::expected<Value, std::string> value)
{
    if (!value) fail(value.error());
    return std::move(*value);
}

void or_fail(const tl::expected<void, std::string>& done)
{
    if (!done) fail(done.error());
}

/// One run of the verb.
class Keys {
public:
    explicit Keys(const KeysOptions& options)
        : options_(options),
          now_s_(runtime::SystemClock{}.wall_ns() / second_ns),
          authority_(or_fail(options.system.file.empty() ? Authority::open(options.out) : Authority::open_or_make(options.out, now_s_)))
    {
    }

    void run()
    {
        if (!options_.system.file.empty()) make_for(options_.system.load_without_joining());
        if (!options_.add.empty()) add();
        for (const auto& name : options_.renew) renew(name);
        for (const auto& name : options_.revoke) revoke(name);
        if (!options_.revoke.empty())
            fmt::print(
                "Processes read {}/shared/revoked.pem when they start: copy it to every host and restart them one after the other.\n",
                options_.out);
    }

private:
    void make_for(const system::System& system)
    {
        const auto level = system.monitor.security.level == bus::SecurityLevel::none ? bus::SecurityLevel::encrypt : system.monitor.security.level;
        or_fail(authority_.govern(system.monitor.bus.domain, level, now_s_));
        fmt::print("{}: domain {}, level {}, keys in {}\n", system.name, authority_.domain(), bus::to_string(level), options_.out);
        for (const auto& member : system::members_of(system)) make(member);
        fmt::print("Copy {0}/shared and {0}/NAME to the host that runs NAME, readable by its user. {0}/authority stays here.\n",
                   options_.out);
    }

    /// Keeps a valid identity.
    void make(const Member& member)
    {
        const auto* known = authority_.find(member.name);
        if (!known || known->revoked || !is_there(member.name)) return issue(member, known ? "made again" : "made");
        if (known->member.access == member.access && known->member.role == member.role) return print(*known, "unchanged");
        or_fail(authority_.permit(member, now_s_));
        print(*authority_.find(member.name), "new permissions: restart it");
    }

    bool is_there(const std::string& name) const
    {
        std::error_code unknown;
        return std::filesystem::exists(std::filesystem::path{options_.out} / name / "key.pem", unknown);
    }

    void issue(const Member& member, std::string_view what)
    {
        or_fail(authority_.issue(member, now_s_, static_cast<std::int64_t>(options_.days * day_s)));
        print(*authority_.find(member.name), what);
    }

    static void print(const IssuedIdentity& identity, std::string_view what)
    {
        const auto expires = static_cast<std::time_t>(identity.certificates.front().expires_s);
        fmt::print("  {:<16}{:<12}valid until {:%Y-%m-%d}  {}\n", identity.member.name, security::to_string(identity.member.role),
                   fmt::gmtime(expires), what);
    }

    void add()
    {
        const auto role = security::role_from(options_.role);
        if (!role) fail(fmt::format("--role: {}", role.error()));
        Member member{options_.add, *role, security::access_of(*role)};
        if (*role == Role::consumer) add_topics_for_ros2(member.access.subscribes);
        std::ranges::copy(options_.publish, std::back_inserter(member.access.publishes));
        std::ranges::copy(options_.subscribe, std::back_inserter(member.access.subscribes));
        const auto* known = authority_.find(member.name);
        if (known && !known->revoked)
            fail(fmt::format("'{}' has an identity already: --renew {} gives it new keys, --revoke {} ends it", member.name, member.name,
                             member.name));
        issue(member, "made");
    }

    /// Adds those that the voters publish.
    void add_topics_for_ros2(std::vector<std::string>& topics) const
    {
        for (const auto& identity : authority_.identities()) {
            for (const auto& topic : identity.member.access.publishes) {
                if (topic.starts_with("rt/") && std::ranges::find(topics, topic) == topics.end()) topics.push_back(topic);
            }
        }
    }

    const IssuedIdentity& identity(const std::string& name) const
    {
        if (const auto* known = authority_.find(name)) return *known;
        std::string names;
        for (const auto& other : authority_.identities()) names += (names.empty() ? "" : ", ") + other.member.name;
        fail(fmt::format("there is no identity '{}'; known are {}", name, names));
    }

    void renew(const std::string& name)
    {
        if (name == "all") {
            for (const auto& other : std::vector(authority_.identities())) {
                if (!other.revoked) issue(other.member, "renewed: restart it");
            }
            return;
        }
        if (identity(name).revoked) fail(fmt::format("'{}' is revoked: --add it again to give it new keys", name));
        issue(Member{identity(name).member}, "renewed: restart it");
    }

    void revoke(const std::string& name)
    {
        (void)identity(name);
        or_fail(authority_.revoke(name, now_s_));
        fmt::print("  {:<16}{:<12}revoked\n", name, security::to_string(identity(name).member.role));
    }

    const KeysOptions& options_;
    std::int64_t now_s_;
    Authority authority_;
};

}  // namespace

void add_keys(Program& program)
{
    auto verb = program.verb("keys", "Make, renew and revoke the keys with which a system runs under DDS Security");
    auto options = std::make_shared<KeysOptions>();
    verb.option("system", options->system.file, "The system file (YAML): every process gets an identity; valid ones are kept")
        .value_name("SYSTEM.yaml");
    verb.option("--out", options->out, "Directory of the keys").required().value_name("DIR");
    verb.option("--domain", options->system.domain, "DDS domain in place of the file's").within(bus::bus_record(), "domain");
    verb.option("--set", options->system.set, "A value in place of the file's (repeatable)").value_name("KEY=VALUE");
    const auto add = verb.option("--add", options->add, "A new identity for another node").value_name("NAME");
    verb.option("--role", options->role, "Role of --add: monitor, operator, consumer, or that of a process: sensor, detector, integrator, voter");
    verb.option("--publish", options->publish, "One more topic that --add may publish (repeatable)").value_name("TOPIC");
    verb.option("--subscribe", options->subscribe, "One more topic that --add may subscribe (repeatable)").value_name("TOPIC");
    verb.option("--renew", options->renew, "New keys for an identity, or for all (repeatable)").value_name("NAME|all");
    verb.option("--revoke", options->revoke, "End an identity before its time (repeatable)").value_name("NAME").in_place_of({add});
    verb.option("--days", options->days, "Days that new certificates are valid").within(settings::above_zero).shows_default();
    verb.footer(
        "Private keys are written with mode 0600 and never printed. docs/security.md explains levels, hosts and rotation.\nExample:\n"
        "  quorient keys system.yaml --out keys\n  quorient keys --out keys --add ground-station --role operator");
    verb.run([options] {
        if (options->system.file.empty() && options->add.empty() && options->renew.empty() && options->revoke.empty())
            fail("nothing to do: a system file, --add, --renew or --revoke is needed");
        Keys{*options}.run();
    });
}

}  // namespace quorient::cli
