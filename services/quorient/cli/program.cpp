#include "program.hpp"

#include "quorient/configuration/suggestion.hpp"
#include "quorient/runtime/log.hpp"
#include "quorient/runtime/options.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <set>
#include <system_error>
#include <type_traits>

namespace quorient::cli {

namespace {

bool is_number(std::string_view text)
{
    double value = 0;
    return !text.empty() && CLI::detail::lexical_cast(std::string(text), value);
}

bool is_number_list(const std::string& argument)
{
    const auto parts = CLI::detail::split(argument, ',');
    return std::all_of(parts.begin(), parts.end(), [](const std::string& part) { return is_number(part); });
}

std::size_t count_of(const std::string& argument)
{
    return 1 + static_cast<std::size_t>(std::count(argument.begin(), argument.end(), ','));
}

std::string example_of(std::size_t count)
{
    std::string numbers = "1";
    while (--count > 0) numbers += ",0";
    return numbers;
}

/// `--initial 1 0 0 0 FILE` becomes `--initial=1,0,0,0 FILE`: in one argument, so that no number is taken for anything else.
/// @param arguments  the verb's name and what follows it. A list of a wrong length ends the verb.
std::vector<std::string> with_joined_lists(const std::vector<NumberList>& lists, const std::vector<std::string>& arguments)
{
    std::vector<std::string> joined;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const auto equals = std::min(arguments[i].find('='), arguments[i].size());
        const auto name = arguments[i].substr(0, equals);
        const auto list = std::find_if(lists.begin(), lists.end(), [&](const NumberList& known) {
            return known.verb == arguments.front() && known.option == name;
        });
        joined.push_back(arguments[i]);
        if (list == lists.end()) continue;
        std::string numbers = equals < arguments[i].size() ? arguments[i].substr(equals + 1) : "";
        std::size_t taken = numbers.empty() ? 0 : count_of(numbers);
        while (i + 1 < arguments.size() && is_number_list(arguments[i + 1]) && (list->count == 0 || taken < list->count)) {
            taken += count_of(arguments[++i]);
            numbers += (numbers.empty() ? "" : ",") + arguments[i];
        }
        if (list->count != 0 && taken != list->count)
            fail(fmt::format("{} takes {} numbers, as in {} {}; got {}", name, list->count, name, example_of(list->count), taken));
        if (!numbers.empty()) joined.back() = name + "=" + numbers;
    }
    return joined;
}

}  // namespace

void fail(std::string_view explanation)
{
    fmt::print(stderr, "{}\n", explanation);
    throw Exit{ExitCode::refused};
}

Option Option::required() const
{
    option_->required();
    return *this;
}

Option Option::one_of(std::vector<std::string> words) const
{
    option_->check(CLI::Validator(
        [words](std::string& given) {
            if (std::find(words.begin(), words.end(), given) != words.end()) return std::string{};
            return fmt::format("unknown word '{}'; known are {}{}", given, configuration::listed(words), configuration::suggestion(given, words));
        },
        "{" + CLI::detail::join(words, ",") + "}"));
    return *this;
}

Option Option::within(const settings::Bounds& bounds) const
{
    number_->bounds = bounds;
    option_->check(CLI::Validator(
        [bounds](std::string& given) {
            double value = 0;
            if (CLI::detail::lexical_cast(given, value) && bounds.hold(value)) return std::string{};
            return fmt::format("must be {}, got {}", bounds.text(), given);
        },
        bounds.text().empty() ? "" : "[" + bounds.text() + "]"));
    return *this;
}

Option Option::shows_default() const
{
    option_->capture_default_str();
    return *this;
}

Option Option::value_name(const std::string& name) const
{
    if (option_->get_positional()) option_->option_text(name);
    else option_->type_name(name);
    return *this;
}

Option Option::in_place_of(std::initializer_list<Option> others) const
{
    for (const Option& other : others) option_->excludes(other.option_);
    return *this;
}

Option Option::in_group(const std::string& title) const
{
    option_->group(title);
    return *this;
}

Option Option::when_given(std::function<void()> check) const
{
    option_->each([check = std::move(check)](const std::string&) { check(); });
    return *this;
}

std::string Option::name() const
{
    return option_->get_name();
}

namespace {

template <class Number>
constexpr bool is_unsigned = std::is_unsigned_v<Number>;
template <class Number>
constexpr bool is_unsigned<std::optional<Number>> = std::is_unsigned_v<Number>;

/// CLI11 takes "-1" for the largest unsigned number.
void refuse_negative(CLI::Option* option, NumberOption& entry)
{
    entry.bounds = settings::not_negative;
    option->check(CLI::Validator(
        [](std::string& given) { return given.starts_with('-') ? fmt::format("must be 0 or more, got {}", given) : std::string{}; }, ""));
}

}  // namespace

Option Verb::numeric(CLI::Option* option)
{
    numbers_->push_back({app_->get_name(), option->get_name(), {}});
    option->check(CLI::Validator(
        [](std::string& given) {
            double value = 0;
            if (!CLI::detail::lexical_cast(given, value)) return fmt::format("'{}' is no number", given);
            return std::isfinite(value) ? std::string{} : fmt::format("must be finite, got {}", given);
        },
        ""));
    return Option{option, &numbers_->back()};
}

template <class Target>
Option Verb::option(const std::string& name, Target& target, const std::string& help)
{
    auto* option = app_->add_option(name, target, help);
    option->allow_extra_args(false);
    constexpr bool is_text = std::is_same_v<Target, std::string> || std::is_same_v<Target, std::optional<std::string>> ||
                             std::is_same_v<Target, std::vector<std::string>>;
    if constexpr (is_text) return Option{option};
    else {
        const auto handle = numeric(option);
        if constexpr (is_unsigned<Target>) refuse_negative(option, numbers_->back());
        return handle;
    }
}

template Option Verb::option(const std::string&, std::string&, const std::string&);
template Option Verb::option(const std::string&, double&, const std::string&);
template Option Verb::option(const std::string&, int&, const std::string&);
template Option Verb::option(const std::string&, unsigned&, const std::string&);
template Option Verb::option(const std::string&, std::uint64_t&, const std::string&);
template Option Verb::option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Verb::option(const std::string&, std::optional<double>&, const std::string&);
template Option Verb::option(const std::string&, std::optional<unsigned>&, const std::string&);
template Option Verb::option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option Verb::option(const std::string&, std::vector<std::string>&, const std::string&);

template <class Number>
Option Verb::numbers(const std::string& name, std::vector<Number>& target, std::size_t count, const std::string& help)
{
    auto* option = app_->add_option(name, target, help)->delimiter(',')->allow_extra_args(false);
    lists_->push_back({app_->get_name(), name, count});
    const auto handle = numeric(option);
    if constexpr (is_unsigned<Number>) refuse_negative(option, numbers_->back());
    return handle;
}

template Option Verb::numbers(const std::string&, std::vector<double>&, std::size_t, const std::string&);
template Option Verb::numbers(const std::string&, std::vector<std::size_t>&, std::size_t, const std::string&);
template Option Verb::numbers(const std::string&, std::vector<unsigned>&, std::size_t, const std::string&);

Option Verb::arguments(const std::string& name, std::vector<std::string>& target, const std::string& help)
{
    return Option{app_->add_option(name, target, help)};
}

Option Verb::flag(const std::string& name, bool& target, const std::string& help)
{
    return Option{app_->add_flag(name, target, help)};
}

void Verb::footer(const std::string& text)
{
    footer_ = text;
    show_footer();
}

void Verb::not_as_asked_if(const std::string& what)
{
    not_as_asked_ = what;
    show_footer();
}

void Verb::show_footer()
{
    const auto gap = footer_.empty() || footer_.ends_with('\n') ? "" : "\n";
    const auto one = not_as_asked_.empty() ? "" : fmt::format("\n  1  {}", not_as_asked_);
    app_->footer(fmt::format("{}{}\nExit codes:\n  0  done{}\n  2  bad usage, bad input, nothing to do, or an output that cannot be written",
                             footer_, gap, one));
}

void Verb::run(std::function<void()> action)
{
    app_->callback(std::move(action));
}

bool Verb::given(const std::string& name) const
{
    const auto* option = app_->get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
}

Program::Program(const std::string& name, const std::string& description) : app_(std::make_unique<CLI::App>(description, name))
{
    app_->set_version_flag("--version", runtime::version());
    app_->require_subcommand(1);
}

Program::~Program() = default;

Verb Program::verb(const std::string& name, const std::string& description)
{
    return Verb{*app_->add_subcommand(name, description), lists_, numbers_};
}

void Program::footer(const std::string& text)
{
    app_->footer(text);
}

std::vector<std::string> Program::verbs() const
{
    std::vector<std::string> names;
    for (const auto* verb : app_->get_subcommands({})) names.push_back(verb->get_name());
    return names;
}

namespace {

/// Sees that what was printed has left. @returns the exit code, `refused` if it has not.
int with_output_written(int exit_code)
{
    errno = 0;
    const bool flushed = std::fflush(stdout) == 0 && static_cast<bool>(std::cout.flush());
    if (flushed && std::ferror(stdout) == 0) return exit_code;
    runtime::say(fmt::format("standard output cannot be written{}", errno != 0 ? fmt::format(": {}", std::strerror(errno)) : ""));
    return ExitCode::refused;
}

/// What looks like an option and is none. CLI11 lists it among what follows it, or says that something else is missing.
std::optional<std::string> unknown_option(const CLI::App& app, const std::string& verb, const std::vector<std::string>& arguments)
{
    for (const std::string& argument : arguments) {
        if (argument == "--") break;
        const std::string name = argument.substr(0, argument.find('='));
        if (!name.starts_with("--") || app.get_option_no_throw(name) != nullptr) continue;
        std::vector<std::string> known;
        for (const auto* option : app.get_options())
            for (const std::string& one : option->get_lnames()) known.push_back("--" + one);
        return fmt::format("unknown option '{}'{}{}\nRun with --help for more information.", name, verb.empty() ? "" : " of " + verb,
                           configuration::suggestion(name, known));
    }
    return std::nullopt;
}

/// A verb or an option that there is not, with a suggestion.
std::optional<std::string> unknown_word(const CLI::App& app, const std::vector<std::string>& verbs, const std::vector<std::string>& arguments)
{
    if (arguments.empty()) return std::nullopt;
    const std::string& verb = arguments.front();
    if (verb.starts_with("-")) return unknown_option(app, "", {verb});
    if (std::find(verbs.begin(), verbs.end(), verb) != verbs.end())
        return unknown_option(*app.get_subcommand(verb), verb, {arguments.begin() + 1, arguments.end()});
    return fmt::format("unknown verb '{}'{}\nRun with --help for a list.", verb, configuration::suggestion(verb, verbs));
}

}  // namespace

int Program::run_verb(std::vector<std::string> arguments)
{
    if (const auto problem = unknown_word(*app_, verbs(), arguments)) {
        runtime::say(*problem);
        return ExitCode::refused;
    }
    try {
        arguments = with_joined_lists(lists_, arguments);
        std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
        app_->parse(std::move(arguments));
    } catch (const Exit& exit) {
        return exit.code;
    } catch (const CLI::ParseError& error) {
        return app_->exit(error) == 0 ? ExitCode::done : ExitCode::refused;
    } catch (const std::system_error& error) {  // from a file or standard output
        runtime::say(error.what());
        return ExitCode::refused;
    }
    return ExitCode::done;
}

int Program::run(std::vector<std::string> arguments)
{
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is an output that cannot be written, like a full disk
    return with_output_written(run_verb(std::move(arguments)));
}

}  // namespace quorient::cli
