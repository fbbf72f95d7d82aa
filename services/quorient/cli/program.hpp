#pragma once

#include <cstddef>
#include <cstdint>
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

/// Ends a verb early, after it has explained itself on stderr.
struct Exit {
    int code;
};

/// Explains bad usage or bad input on stderr and ends the verb with exit code 2.
[[noreturn]] void fail(std::string_view explanation);

/// One option, flag or positional argument of a verb: what may stand in it. A handle; copies mean the same option.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option required() const;
    Option one_of(std::vector<std::string> words) const;
    Option between(double lowest, double highest) const;
    Option positive() const;
    Option shows_default() const;                          ///< its value before parsing stands in the help
    Option value_name(const std::string& name) const;      ///< as the help calls the value: FILE
    Option in_place_of(std::initializer_list<Option> others) const;  ///< cannot be given together with any of these
    Option in_group(const std::string& title) const;       ///< stands under a heading of its own in the help
    Option when_given(std::function<void()> check) const;  ///< called once for each value
    std::string name() const;  ///< as the user types it

private:
    CLI::Option* option_;
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
    /// @param lists  the program's, where this verb adds its own
    Verb(CLI::App& app, std::vector<NumberList>& lists) : app_(&app), lists_(&lists) {}

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

    /// Text behind the options in the help: remarks and an example.
    void footer(const std::string& text);
    void run(std::function<void()> action);

    /// Whether the option was given on the command line.
    bool given(const std::string& name) const;

private:
    CLI::App* app_;
    std::vector<NumberList>* lists_;
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

    /// Runs the verb of these arguments (without the program's name).
    /// @returns the exit code: 2 on bad usage, which has been explained on stderr; else what the verb ended with.
    int run(std::vector<std::string> arguments);

private:
    std::unique_ptr<CLI::App> app_;
    std::vector<NumberList> lists_;
};

}  // namespace quorient::cli
