#include "quorient/configuration/table.hpp"
#include "quorient/configuration/reference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <array>

namespace quorient::configuration {

namespace {

using testing::HasSubstr;
using testing::Not;

enum class Wave { sine, square };

struct Filter {
    double corner_hz = 10;
    std::optional<double> damping{};
};

struct Channel {
    std::string name;
    std::string colour = "red";
    Filter filter;
};

struct Instrument {
    std::string colour = "red";
    Wave wave = Wave::sine;
    double duty = 0.5;
    std::vector<double> weights;
    std::vector<Channel> channels;
    std::optional<Filter> output;
};

constexpr std::array<settings::Setting<Filter>, 2> filter_record{{
    {"corner_hz", &Filter::corner_hz, "Hz", settings::above_zero, "Where it begins to damp."},
    {"damping", &Filter::damping, "", settings::probability, "How much.", "as the corner says"},
}};

const Table<Filter>& filter_table()
{
    static const Table<Filter> table{"Takes out noise.", {record<Filter>(filter_record)}};
    return table;
}

template <class Owner>
Rows<Owner> colour_row()
{
    return value({.name = "colour", .sentence = "Of its line."}, &Owner::colour);
}

const Table<Channel>& channel_table()
{
    static const Table<Channel> table{
        "One input.",
        {required(value({.name = "name", .sentence = "Of the channel."}, &Channel::name)), inherited(colour_row<Channel>()),
         part({.name = "filter", .sentence = "Before all else."}, &Channel::filter, filter_table())}};
    return table;
}

const Table<Instrument>& instrument_table()
{
    static const Table<Instrument> table{
        "An oscilloscope.",
        {colour_row<Instrument>(),
         word<Instrument, Wave>({.name = "wave", .sentence = "Of the generator."}, "wave", &Instrument::wave,
                                {{"sine", Wave::sine}, {"square", Wave::square}}),
         value({.name = "weights", .bounds = settings::not_negative, .sentence = "Of the channels."}, &Instrument::weights),
         list<Instrument, Channel>({.name = "channels", .sentence = "What is measured."}, &Instrument::channels, channel_table(), 2,
                                   [](const Instrument& owner, Channel& channel, std::size_t) { channel.colour = owner.colour; }),
         part({.name = "output", .otherwise = "none", .sentence = "What goes out."}, &Instrument::output, filter_table())},
        {{"wave: square", "A square wave.", [](const Instrument& values) { return values.wave == Wave::square; },
          value({.name = "duty", .bounds = settings::probability, .sentence = "Share of the time on."}, &Instrument::duty)}}};
    return table;
}

struct Reading {
    explicit Reading(const std::string& text)
    {
        Section section{YAML::Load(text), "", problems};
        instrument_table().read(section, values);
    }
    Problems problems{"x.yaml"};
    Instrument values;
};

}  // namespace

TEST(Table, reads_every_key_into_its_member)
{
    const Reading reading(
        "colour: blue\nwave: square\nduty: 0.25\nweights: [1, 2]\n"
        "channels: [{name: a, filter: {corner_hz: 5}}, {name: b, colour: green}]\noutput: {damping: 0.5}");
    ASSERT_TRUE(reading.problems.empty()) << reading.problems.text();
    EXPECT_EQ(reading.values.wave, Wave::square);
    EXPECT_EQ(reading.values.duty, 0.25);
    EXPECT_EQ(reading.values.weights, (std::vector<double>{1, 2}));
    ASSERT_EQ(reading.values.channels.size(), 2U);
    EXPECT_EQ(reading.values.channels[0].filter.corner_hz, 5);
    EXPECT_EQ(reading.values.channels[0].colour, "blue") << "as the whole file";
    EXPECT_EQ(reading.values.channels[1].colour, "green");
    EXPECT_EQ(reading.values.output->damping, 0.5);
}

TEST(Table, reports_every_value_out_of_bounds_at_its_key)
{
    const Reading reading("wave: triangle\nweights: [-1]\nchannels:\n  - {name: a, filter: {corner_hz: 0, damping: 1}}");
    EXPECT_EQ(reading.problems.text(),
              "x.yaml:1:7: wave: unknown wave 'triangle'; there are sine and square\n"
              "x.yaml:2:11: weights[0]: expected a number, 0 or more, got '-1'\n"
              "x.yaml:4:35: channels[0].filter.corner_hz: must be above 0 [Hz], got 0\n"
              "x.yaml:4:47: channels[0].filter.damping: must be above 0 and below 1, got 1\n"
              "4 problems, nothing started");
}

TEST(Table, knows_the_keys_of_the_variant_that_holds_and_of_no_other)
{
    EXPECT_THAT(Reading("wave: sine\nduty: 0.2").problems.text(), HasSubstr("unknown key 'duty'"));
    EXPECT_TRUE(Reading("wave: square\nduty: 0.2").problems.empty());
}

TEST(Table, misses_a_key_that_must_be_given)
{
    EXPECT_THAT(Reading("channels: [{colour: red}]").problems.text(), HasSubstr("channels[0].name is missing"));
}

TEST(Table, refuses_more_items_than_there_may_be)
{
    EXPECT_THAT(Reading("channels: [{name: a}, {name: b}, {name: c}]").problems.text(), HasSubstr("channels: at most 2 channels, got 3"));
}

TEST(Table, writes_what_reads_back_to_the_same)
{
    const Reading first(
        "colour: 'x: #1'\nwave: square\nduty: 0.1\nweights: [0.1, 1.0e-9, 3]\n"
        "channels: [{name: 'a, b', filter: {corner_hz: 0.3}}, {name: 'null', colour: green}]\noutput: {}");
    ASSERT_TRUE(first.problems.empty()) << first.problems.text();
    const auto text = to_text(instrument_table().write(first.values));
    const Reading second(text);
    ASSERT_TRUE(second.problems.empty()) << second.problems.text() << "\n" << text;
    EXPECT_EQ(to_text(instrument_table().write(second.values)), text);
    EXPECT_EQ(second.values.colour, "x: #1");
    EXPECT_EQ(second.values.weights, first.values.weights);
    EXPECT_EQ(second.values.channels[0].name, "a, b");
    EXPECT_EQ(second.values.channels[0].colour, "x: #1");
    EXPECT_EQ(second.values.channels[1].name, "null");
    EXPECT_TRUE(second.values.output);
}

TEST(Table, writes_an_inherited_key_only_where_it_differs)
{
    const Reading reading("colour: blue\nchannels: [{name: a}, {name: b, colour: green}]");
    const auto written = instrument_table().write(reading.values);
    EXPECT_FALSE(written["channels"][0]["colour"]);
    EXPECT_EQ(written["channels"][1]["colour"].Scalar(), "green");
}

TEST(Table, leaves_out_what_is_absent)
{
    const auto written = instrument_table().write(Reading("channels: [{name: a}]").values);
    EXPECT_FALSE(written["output"]);
    EXPECT_FALSE(written["channels"][0]["filter"]["damping"]);
}

TEST(Reference, states_every_key_with_value_default_and_sentence)
{
    const auto page = reference(instrument_table().chapter(), "instrument");
    EXPECT_THAT(page, HasSubstr("\n## instrument\n\nAn oscilloscope.\n"));
    EXPECT_THAT(page, HasSubstr("| `wave` | one of sine and square | sine | Of the generator. |"));
    EXPECT_THAT(page, HasSubstr("**With `wave: square`:** A square wave."));
    EXPECT_THAT(page, HasSubstr("| `duty` | number, above 0 and below 1 | 0.5 | Share of the time on. |"));
    EXPECT_THAT(page, HasSubstr("| `channels` | list of mappings: [channels[]](#channels) |"));
    EXPECT_THAT(page, HasSubstr("\n## channels[].filter\n"));
    EXPECT_THAT(page, HasSubstr("| `corner_hz` | number, above 0 [Hz] | 10 | Where it begins to damp. |"));
    EXPECT_THAT(page, HasSubstr("| `damping` | number, above 0 and below 1 | as the corner says | How much. |"));
    EXPECT_THAT(page, HasSubstr("| `name` | text | must be given | Of the channel. |"));
    EXPECT_THAT(page, HasSubstr("| `colour` | text | as the whole file | Of its line. |"));
}

TEST(Explanation, shows_one_key_or_all_keys_of_a_mapping)
{
    const auto chapter = instrument_table().chapter();
    EXPECT_EQ(explanation_of(chapter, "channels.filter.corner_hz"),
              "corner_hz: number, above 0 [Hz]; left out: 10\n    Where it begins to damp.\n");
    EXPECT_THAT(*explanation_of(chapter, "output"), HasSubstr("damping: "));
    EXPECT_FALSE(explanation_of(chapter, "channels.volume"));
    const auto all = explanation(chapter, "instrument");
    for (const char* text :
         {"instrument\nAn oscilloscope.\n", "With wave: square: A square wave.\n", "\nchannels[].filter\nTakes out noise.\ncorner_hz: "})
        EXPECT_THAT(all, HasSubstr(text));
}

}  // namespace quorient::configuration
