#pragma once

#include "quorient/settings/setting.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace quorient::cli {

/// How every verb ends; the help of each verb states it.
struct ExitCode {
    static constexpr int done = 0;          ///< whatever was measured
    static constexpr int not_as_asked = 1;  ///< what the verb waits for did not come, or is not as it must be
    static constexpr int refused = 2;       ///< bad usage, bad input, nothing to do, or an output that cannot be written
};

/// Ends a verb early, after it has explained itself on stderr.
struct Exit {
    int code;
};

/// Explains on stderr why the verb does not do what it was asked, and ends it with exit code 2.
[[noreturn]] void fail(std::string_view explanation);

/// An option that takes numbers, and which it takes.
struct NumberOption {
    std::string verb;
    std::string option;
    settings::Bounds bounds;  ///< for each number; what is not finite is always refused
};

/// One option, flag or positional argument of a verb: what may stand in it. A handle; copies mean the same option.
class Option {
public:
    /// @param number  the program's entry for an option that takes numbers
    explicit Option(CLI::Option* option, NumberOption* number = nullptr) : option_(option), number_(number) {}

    Option required() const;
    Option one_of(std::vector<std::string> words) const;

    /// The values that each number of the option may have.
    Option within(const settings::Bounds& bounds) const;

    /// The same by the record of the setting.
    template <class Settings>
    Option within(settings::Record<Settings> record, std::string_view key) const
    {
        return within(std::ranges::find(record, key, &settings::Setting<Settings>::key)->bounds);
    }

    Option shows_default() const;                          ///< its value before parsing stands in the help
    Option value_name(const std::string& name) const;      ///< as the help calls the value: FILE
    Option in_place_of(std::initializer_list<Option> others) const;  ///< cannot be given together with any of these
    Option in_group(const std::string& title) const;       ///< stands under a heading of its own in the help
    Option when_given(std::function<void()> check) const;  ///< called once for each value
    std::string name() const;  ///< as the user types it

private:
    CLI::Option* option_;
    NumberOption* number_;
};

/// An option that takes several numbers.
struct NumberList {
    std::string verb;
    std::string option;
    std::size_t count = 0;  ///< 0 = one or more
};

/// One sub-command with its options. Values are written to their targets, which outlive the parsing.
///
/// Lists of numbers stand in one argument (`--initial 1,0,0,0`) or in several (`--initial 1 0 0 0`); the option takes as many numbers as it
/// wants and leaves what follows to others. Lists of words take one word each time the option is given.
class Verb {
public:
    /// @param lists, numbers  the program's, where this verb adds its own
    Verb(CLI::App& app, std::vector<NumberList>& lists, std::deque<NumberOption>& numbers) : app_(&app), lists_(&lists), numbers_(&numbers)
    {
        footer({});
    }

    /// `Target`: std::string, double, int, unsigned, std::uint64_t, std::optional of these, or std::vector<std::string>.
    /// @param name  "--sigma" for an option, "file" for a positional argument.
    template <class Target>
    Option option(const std::string& name, Target& target, const std::string& help);

    /// @param count  how many numbers; 0 = one or more.
    template <class Number>
    Option numbers(const std::string& name, std::vector<Number>& target, std::size_t count, const std::string& help);

    /// All positional arguments that are left.
    Option arguments(const std::string& name, std::vector<std::string>& target, const std::string& help);

    Option flag(const std::string& name, bool& target, const std::string& help);

    /// Text behind the options in the help: remarks and an example. The exit codes follow.
    void footer(const std::string& text);

    /// When the verb ends with not_as_asked, for the help; without it, it never does.
    void not_as_asked_if(const std::string& what);

    void run(std::function<void()> action);

    /// Whether the option was given on the command line.
    bool given(const std::string& name) const;

private:
    void show_footer();
    Option numeric(CLI::Option* option);

    CLI::App* app_;
    std::vector<NumberList>* lists_;
    std::deque<NumberOption>* numbers_;
    std::string footer_;
    std::string not_as_asked_;
};

/// A program of verbs, as git is.
class Program {
public:
    /// @param name  as the user types it.
    Program(const std::string& name, const std::string& description);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    Verb verb(const std::string& name, const std::string& description);
    void footer(const std::string& text);

    std::vector<std::string> verbs() const;
    const std::vector<NumberList>& number_lists() const { return lists_; }
    const std::deque<NumberOption>& number_options() const { return numbers_; }

    /// Runs the verb of these arguments (without the program's name), and sees that its output was written.
    /// @returns the exit code: `refused` where that was not done, which has been explained on stderr; else what the verb ended with.
    int run(std::vector<std::string> arguments);

private:
    int run_verb(std::vector<std::string> arguments);

    std::unique_ptr<CLI::App> app_;
    std::vector<NumberList> lists_;
    std::deque<NumberOption> numbers_;  // options point to their own
};

}  // namespace quorient::cli
