#include "cli/message_json.hpp"
#include "cli/message_words.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "cli/system_options.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <set>

namespace quorient::cli {

namespace {

/// After which a user wonders whether anything comes at all.
constexpr std::int64_t patience_ns = 5'000'000'000;

struct EchoOptions {
    BusOptions bus;
    std::string topic;
    std::uint64_t count = 0;
    double timeout_s = 0;
    bool json = false;
};

/// `frame` stands for `quorient/frame`.
std::string full_name(const std::string& topic)
{
    return topic.find('/') == std::string::npos ? "quorient/" + topic : topic;
}

/// Whole numbers are for people here, however large.
std::string text_of_value(const Json& value)
{
    return value.is_number_integer() ? value.dump() : dump(value);
}

/// @returns false where standard output takes no more.
template <class Message>
bool show(const Message& message, bool json)
{
    const auto fields = message_json(message);
    if (json) {
        fmt::print("{}\n", dump(fields));
    } else {
        for (const auto& [name, value] : fields.items()) {
            const auto word = word_in(message, name);
            fmt::print("{}: {}{}\n", name, text_of_value(value), word.empty() ? std::string{} : fmt::format(" ({})", word));
        }
        fmt::print("---\n");
    }
    return std::fflush(stdout) == 0;
}

/// What came, for those that see too little.
struct Came {
    std::uint64_t shown = 0;
    std::set<std::uint32_t> other_units;

    std::string explained(const EchoOptions& options) const
    {
        const auto others = other_units.empty() ? std::string{} : fmt::format("; there are samples of unit {}", fmt::join(other_units, ", "));
        return fmt::format("no sample of {} of unit {} came in domain {} on '{}'{}", full_name(options.topic), options.bus.unit,
                           options.bus.joined_domain(), options.bus.interface, others);
    }
};

int echo(const EchoOptions& options)
{
    const auto bus = options.bus.open("quorient-echo");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    Came came;
    bool known = false;
    std::vector<std::string> names;
    const auto subscribe_if_named = [&](const auto& topic) {
        using Message = typename std::decay_t<decltype(topic)>::Message;
        names.emplace_back(topic.spec.name);
        if (full_name(options.topic) != topic.spec.name) return;
        known = true;
        loop.on(bus->subscribe(topic), [&](const Message& message) {
            if (message.unit != options.bus.unit) return void(came.other_units.insert(message.unit));
            if (options.count != 0 && came.shown == options.count) return;
            if (!show(message, options.json) || ++came.shown == options.count) loop.quit(ExitCode::done);
        });
    };
    std::apply([&](const auto&... topic) { (subscribe_if_named(topic), ...); }, bus::topics::all);
    if (!known) {
        fmt::print(stderr, "unknown topic '{}'; known are {}\n", options.topic, fmt::join(names, ", "));
        return 2;
    }
    if (options.timeout_s > 0)
        loop.timer([&] { loop.quit(ExitCode::not_as_asked); }).set(clock.steady_ns() + nanoseconds(options.timeout_s));
    loop.timer([&] {
            if (came.shown == 0) fmt::print(stderr, "{} yet\n", came.explained(options));
        }).set(clock.steady_ns() + patience_ns);
    const int exit_code = loop.run();
    if (exit_code == ExitCode::not_as_asked)
        fmt::print(stderr, "{}\n",
                   came.shown == 0 ? came.explained(options) : fmt::format("{} samples came in {:g} s", came.shown, options.timeout_s));
    return exit_code;
}

}  // namespace

void add_echo(Program& program)
{
    auto verb = program.verb("echo", "Print the samples of a topic");
    auto options = std::make_shared<EchoOptions>();
    options->bus.add_to(verb);
    verb.option("topic", options->topic, "quorient/voter_output, or voter_output").required();
    verb.option("--count", options->count, "End after so many samples; 0 = go on");
    verb.option("--timeout", options->timeout_s, "End with exit code 1 after so many seconds; 0 = go on")
        .within(settings::not_negative)
        .value_name("S");
    verb.option("--lease", options->bus.voted_lease_s, "Of `voted`, if above max(50 ms, 3 intervals) in the system file")
        .within(settings::above_zero)
        .value_name("S")
        .shows_default();
    verb.flag("--json", options->json, "One JSON object per sample");
    verb.footer("Example:\n  quorient echo voter_output --count 3 --json");
    verb.not_as_asked_if("--timeout ended before --count samples had come");
    verb.run([options] {
        if (const int exit_code = echo(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
