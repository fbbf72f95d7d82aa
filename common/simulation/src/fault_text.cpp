#include "quorient/messages/meaning.hpp"
#include "quorient/simulation/faults.hpp"

#include <fmt/format.h>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

namespace quorient::simulation {
namespace {

struct Kind {
    std::string_view word;
    FaultKind kind;
    std::string_view unit;  // unit of the value; empty = the kind has no value
};

constexpr std::array kinds{
    Kind{"bias", FaultKind::bias, "rad/s"},
    Kind{"ramp", FaultKind::ramp, "rad/s^2"},
    Kind{"scale", FaultKind::scale, "a factor"},
    Kind{"stuck", FaultKind::stuck, ""},
    Kind{"zero", FaultKind::zero, ""},
    Kind{"rail", FaultKind::rail, ""},
    Kind{"sign", FaultKind::sign, ""},
    Kind{"nan", FaultKind::nan, ""},
    Kind{"noise", FaultKind::noise, "a multiple of the axis's sigma"},
    Kind{"oscillation", FaultKind::oscillation, "rad/s"},
    Kind{"dropout", FaultKind::dropout, "a fraction of the frames"},
    Kind{"delay", FaultKind::delay, "seconds"},
    Kind{"spike", FaultKind::spike, "rad/s"},
};

constexpr std::array<std::string_view, 8> keys{"axis", "instrument", "kind", "value", "start", "end", "frequency", "period"};

const Kind* find_kind(FaultKind kind)
{
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& candidate) { return candidate.kind == kind; });
    return found == kinds.end() ? nullptr : &*found;
}

std::string kind_words()
{
    std::string words;
    for (const Kind& kind : kinds) words += fmt::format("{}{}", words.empty() ? "" : ", ", kind.word);
    return words;
}

tl::expected<double, std::string> parse_number(std::string_view key, std::string_view word)
{
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || end != word.data() + word.size() || std::isnan(number))
        return tl::unexpected(fmt::format("{} is not a number: '{}'", key, word));
    return number;
}

tl::expected<AxisMask, std::string> parse_axes(std::string_view word)
{
    AxisMask axes = 0;
    for (std::size_t begin = 0; begin <= word.size();) {
        const std::size_t end = std::min(word.find('+', begin), word.size());
        const std::string_view part = word.substr(begin, end - begin);
        unsigned axis = 0;
        const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), axis);
        if (error != std::errc{} || stop != part.data() + part.size() || axis >= max_axes)
            return tl::unexpected(fmt::format("axis must be 0 … {} (0-based; several as 1+3), got '{}'", max_axes - 1, part));
        axes |= axis_bit(axis);
        begin = end + 1;
    }
    return axes;
}

/// Whether one of `a+b` is neither a number nor meant as one.
bool has_name(std::string_view text)
{
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find('+', begin), text.size());
        const std::string_view word = text.substr(begin, end - begin);
        if (!word.starts_with('-') && word.find_first_not_of("0123456789") != std::string_view::npos) return true;
        begin = end + 1;
    }
    return false;
}

/// One key=value into the fault; the error says what is wrong.
tl::expected<void, std::string> set(FaultSpec& fault, std::string_view key, std::string_view word)
{
    if (key == "axis") {
        const auto axes = parse_axes(word);
        if (!axes) return tl::unexpected(axes.error());
        fault.axes = *axes;
        return {};
    }
    if (key == "instrument") {
        if (word.empty()) return tl::unexpected(std::string("instrument needs a name"));
        fault.instrument = word;
        return {};
    }
    if (key == "kind") {
        const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.word == word; });
        if (found == kinds.end()) return tl::unexpected(fmt::format("unknown kind '{}'; valid: {}", word, kind_words()));
        fault.kind = found->kind;
        return {};
    }
    const auto number = parse_number(key, word);
    if (!number) return tl::unexpected(number.error());
    double& place = key == "value"       ? fault.value
                    : key == "start"     ? fault.start_s
                    : key == "end"       ? fault.end_s
                    : key == "frequency" ? fault.frequency_hz
                                         : fault.period_s;
    place = *number;
    return {};
}

using Given = std::array<bool, keys.size()>;

bool given_key(const Given& given, std::string_view key)
{
    return given[static_cast<std::size_t>(std::find(keys.begin(), keys.end(), key) - keys.begin())];
}

/// Which keys belong together, or what is missing.
std::string missing_or_superfluous(const FaultSpec& fault, const Given& given)
{
    if (!given_key(given, "kind")) return fmt::format("kind is missing; valid: {}", kind_words());
    if (given_key(given, "axis") == given_key(given, "instrument")) return "name what fails: either axis= or instrument=";
    const Kind& kind = *find_kind(fault.kind);
    if (kind.unit.empty() && given_key(given, "value")) return fmt::format("kind {} takes no value", kind.word);
    if (!kind.unit.empty() && !given_key(given, "value")) return fmt::format("kind {} needs value= ({})", kind.word, kind.unit);
    if (given_key(given, "frequency") != (fault.kind == FaultKind::oscillation))
        return "frequency= (Hz) belongs to kind oscillation, which needs it";
    if (given_key(given, "period") != (fault.kind == FaultKind::spike)) return "period= (s) belongs to kind spike, which needs it";
    return {};
}

/// Figures that no cluster could accept.
std::string out_of_range(const FaultSpec& fault)
{
    if (!std::isfinite(fault.value)) return "value must be finite";
    if (!std::isfinite(fault.start_s) || fault.start_s < 0) return fmt::format("start must be 0 s or later, got {}", fault.start_s);
    if (!(fault.end_s > fault.start_s)) return fmt::format("end ({} s) must come after start ({} s)", fault.end_s, fault.start_s);
    if (fault.kind == FaultKind::dropout && !(fault.value > 0 && fault.value <= 1)) return "value of dropout must lie in (0, 1]";
    if (fault.kind == FaultKind::noise && !(fault.value > 0)) return "value of noise must be above 0";
    if (fault.kind == FaultKind::delay && !(fault.value > 0)) return "value of delay must be above 0 s";
    if (fault.kind == FaultKind::oscillation && !(fault.frequency_hz > 0 && std::isfinite(fault.frequency_hz)))
        return "frequency must be above 0 Hz";
    if (fault.kind == FaultKind::spike && !(fault.period_s > 0 && std::isfinite(fault.period_s))) return "period must be above 0 s";
    return {};
}

tl::expected<AxisMask, std::string> axes_of(const std::string& instrument, const geometry::SensorCluster& cluster)
{
    const auto& names = cluster.instrument_name;
    auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), instrument) - names.begin());
    if (index == names.size()) {
        const auto [end, error] = std::from_chars(instrument.data(), instrument.data() + instrument.size(), index);
        if (error != std::errc{} || end != instrument.data() + instrument.size()) index = max_axes;
    }
    const AxisMask axes = index < max_axes ? cluster.axes_of(index) : 0;
    if (axes == 0) {
        std::string known;
        for (const std::string& name : names) known += fmt::format("{}{}", known.empty() ? "" : ", ", name);
        return tl::unexpected(fmt::format("no instrument '{}' in this cluster; it has: {}", instrument, known));
    }
    return axes;
}

}  // namespace

tl::expected<FaultSpec, std::string> parse_fault(std::string_view text, const AxisNames& names)
{
    const auto refuse = [&](const std::string& why) { return tl::unexpected(fmt::format("fault '{}': {}", text, why)); };
    FaultSpec fault;
    Given given{};
    std::optional<std::string_view> named;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string_view pair = text.substr(begin, end - begin);
        const std::size_t equals = pair.find('=');
        const std::string_view key = pair.substr(0, equals);
        const auto* const known = std::find(keys.begin(), keys.end(), key);
        if (equals == std::string_view::npos || known == keys.end())
            return refuse(fmt::format("unknown word '{}'; valid keys: {}", pair, fmt::join(keys, "=, ")) + "=");
        bool& seen = given[static_cast<std::size_t>(known - keys.begin())];
        if (seen) return refuse(fmt::format("'{}' stands twice", key));
        seen = true;
        const std::string_view word = pair.substr(equals + 1);
        if (key == "axis" && names && has_name(word)) named = word;
        else if (const auto done = set(fault, key, word); !done) return refuse(done.error());
        begin = end + 1;
    }
    if (const auto why = missing_or_superfluous(fault, given); !why.empty()) return refuse(why);
    if (const auto why = out_of_range(fault); !why.empty()) return refuse(why);
    if (!named) return fault;
    const auto axes = names(*named);
    if (!axes) return refuse(axes.error());
    fault.axes = *axes;
    return fault;
}

std::string_view to_string(FaultKind kind)
{
    const Kind* const found = find_kind(kind);
    return found == nullptr ? "unknown" : found->word;
}

std::string to_string(const FaultSpec& fault)
{
    std::string text = fault.instrument.empty() ? "axis=" : "instrument=" + fault.instrument;
    for (std::size_t axis = 0, count = 0; axis < max_axes && fault.instrument.empty(); ++axis)
        if (has_axis(fault.axes, axis)) text += fmt::format("{}{}", count++ == 0 ? "" : "+", axis);
    text += fmt::format(",kind={}", to_string(fault.kind));
    const Kind* const kind = find_kind(fault.kind);
    if (kind != nullptr && !kind->unit.empty()) text += fmt::format(",value={}", fault.value);
    if (fault.kind == FaultKind::oscillation) text += fmt::format(",frequency={}", fault.frequency_hz);
    if (fault.kind == FaultKind::spike) text += fmt::format(",period={}", fault.period_s);
    text += fmt::format(",start={:.12g}", fault.start_s);
    if (std::isfinite(fault.end_s)) text += fmt::format(",end={:.12g}", fault.end_s);
    return text;
}

FaultCommand to_command(const FaultSpec& fault)
{
    FaultCommand command;
    command.action = octet(CommandAction::inject);
    command.axes = fault.axes;
    command.kind = octet(fault.kind);
    command.value = fault.value;
    command.start_s = fault.start_s;
    command.end_s = fault.end_s;
    command.frequency_hz = fault.frequency_hz;
    command.period_s = fault.period_s;
    return command;
}

FaultSpec from_command(const FaultCommand& command, double now_s)
{
    FaultSpec fault;
    fault.axes = command.axes;
    fault.kind = fault_of(command);
    fault.value = command.value;
    fault.start_s = now_s + command.start_s;
    fault.end_s = now_s + command.end_s;
    fault.frequency_hz = command.frequency_hz;
    fault.period_s = command.period_s;
    return fault;
}

tl::expected<FaultSpec, std::string> resolve(const FaultSpec& fault, const geometry::SensorCluster& cluster)
{
    const auto refuse = [&](const std::string& why) { return tl::unexpected(fmt::format("fault '{}': {}", to_string(fault), why)); };
    if (find_kind(fault.kind) == nullptr) return refuse(fmt::format("unknown kind; valid: {}", kind_words()));
    if (const auto why = out_of_range(fault); !why.empty()) return refuse(why);

    FaultSpec resolved = fault;
    if (!fault.instrument.empty()) {
        const auto axes = axes_of(fault.instrument, cluster);
        if (!axes) return refuse(axes.error());
        resolved.axes = *axes;
        resolved.instrument.clear();
    }
    if (resolved.axes == 0 || (resolved.axes & ~cluster.all()) != 0)
        return refuse(fmt::format("this cluster has the axes 0 … {}", cluster.size() - 1));
    if (fault.kind == FaultKind::delay &&
        !(cluster.interval_s > 0 && fault.value / cluster.interval_s <= FaultInjector::delay_history_frames - 2))
        return refuse(
            fmt::format("a delay can be at most {} intervals of {} s", FaultInjector::delay_history_frames - 2, cluster.interval_s));
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        if (!has_axis(resolved.axes, axis)) continue;
        const auto row = static_cast<Eigen::Index>(axis);
        if (fault.kind == FaultKind::rail && !(cluster.range(row) > 0)) return refuse(fmt::format("axis {} has no stated range", axis));
        if (fault.kind == FaultKind::noise && !(cluster.sigma(row) > 0)) return refuse(fmt::format("axis {} has no stated sigma", axis));
    }
    return resolved;
}

}  // namespace quorient::simulation
