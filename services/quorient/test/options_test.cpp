#include "run_verb.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <set>

namespace quorient::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The command line as it is installed.
class CommandLine : public testing::Test {
protected:
    CommandLine() { add_verbs(program); }

    Output with(const NumberOption& option, const std::string& value)
    {
        return run_program(program, fmt::format("{} {}={}", option.verb, option.option, value));
    }

    void expect_refused(const NumberOption& option, const std::string& value)
    {
        const auto output = with(option, value);
        EXPECT_EQ(output.exit_code, ExitCode::refused) << option.verb << " " << option.option << "=" << value;
        EXPECT_THAT(output.error, HasSubstr(option.option)) << option.verb << " " << option.option << "=" << value;
    }

    Program program{"quorient", ""};
};

/// As many numbers as the option takes, all of this value.
std::string repeated(const Program& program, const NumberOption& option, const std::string& value)
{
    for (const auto& list : program.number_lists()) {
        if (list.verb != option.verb || list.option != option.option || list.count == 0) continue;
        std::string text = value;
        for (std::size_t i = 1; i < list.count; ++i) text += "," + value;
        return text;
    }
    return value;
}

TEST_F(CommandLine, refuses_at_every_number_what_is_none_or_not_finite)
{
    EXPECT_GT(program.number_options().size(), 50U);
    for (const auto& option : program.number_options())
        for (const char* value : {"many", "nan", "inf", "-inf", "1e999", "0x"}) expect_refused(option, repeated(program, option, value));
}

TEST_F(CommandLine, refuses_numbers_beyond_their_bounds_at_the_option)
{
    for (const auto& option : program.number_options()) {
        const auto& bounds = option.bounds;
        if (std::isfinite(bounds.lowest))
            expect_refused(option, repeated(program, option, fmt::format("{}", bounds.lowest_included ? bounds.lowest - 1 : bounds.lowest)));
        if (std::isfinite(bounds.highest))
            expect_refused(option, repeated(program, option, fmt::format("{}", bounds.highest_included ? bounds.highest + 1 : bounds.highest)));
    }
}

TEST_F(CommandLine, bounds_every_number_that_is_not_of_any_sign)
{
    const std::set<std::string> of_any_sign{"simulate --k2",         "simulate --k3",       "simulate --mu", "simulate --nu",
                                            "simulate --rate-deg-s", "simulate --at",       "assess --direction",
                                            "propagate --initial",   "reset --attitude"};
    for (const auto& option : program.number_options()) {
        const auto name = option.verb + " " + option.option;
        const bool is_bounded = std::isfinite(option.bounds.lowest);
        EXPECT_NE(is_bounded, of_any_sign.contains(name)) << name;
    }
}

TEST_F(CommandLine, takes_as_many_numbers_as_a_list_wants_and_leaves_the_rest)
{
    for (const auto& list : program.number_lists()) {
        if (list.count == 0) continue;
        const auto line = list.verb + " " + list.option + std::string(" 1") + (list.count == 2 ? " 0" : list.count == 3 ? " 0 0" : " 0 0 0");
        const auto output = run_program(program, line + " no-such-file");
        EXPECT_THAT(output.error, Not(HasSubstr(list.option + " takes"))) << line << ": " << output.error;
        EXPECT_THAT(run_program(program, list.verb + " " + list.option + " 1").error, HasSubstr(fmt::format("takes {} numbers", list.count)));
    }
}

TEST_F(CommandLine, suggests_the_verb_that_was_meant)
{
    const auto output = run_program(program, "replya x.csv");
    EXPECT_EQ(output.exit_code, ExitCode::refused);
    EXPECT_THAT(output.error, HasSubstr("unknown verb 'replya'; did you mean 'replay'?"));
}

TEST_F(CommandLine, suggests_the_option_that_was_meant_before_it_complains_of_anything_else)
{
    const auto near = run_program(program, "replay x.csv --sytem s.yaml");  // which also lacks --system
    EXPECT_EQ(near.exit_code, ExitCode::refused);
    EXPECT_THAT(near.error, HasSubstr("unknown option '--sytem' of replay; did you mean '--system'?"));
    EXPECT_THAT(run_program(program, "layout cone-4 --wihout=1").error, HasSubstr("unknown option '--wihout' of layout; did you mean '--without'?"));
    EXPECT_THAT(run_program(program, "layout cone-4 --nothing-like-it").error, HasSubstr("unknown option '--nothing-like-it' of layout\n"));
    EXPECT_THAT(run_program(program, "--verison").error, HasSubstr("did you mean '--version'?"));
}

TEST_F(CommandLine, takes_every_option_that_it_has)
{
    for (const auto& option : program.number_options())
        EXPECT_THAT(run_program(program, option.verb + " " + option.option + " x").error, Not(HasSubstr("unknown option")))
            << option.verb << option.option;
    for (const auto& verb : program.verbs()) EXPECT_EQ(run_program(program, verb + " --help").exit_code, ExitCode::done) << verb;
}

TEST_F(CommandLine, states_in_every_help_how_a_verb_ends)
{
    for (const auto& verb : program.verbs()) {
        const auto output = run_program(program, verb + " --help");
        EXPECT_EQ(output.exit_code, ExitCode::done);
        EXPECT_THAT(output.out, HasSubstr("Exit codes:\n  0  done")) << verb;
    }
}

}  // namespace
}  // namespace quorient::cli
