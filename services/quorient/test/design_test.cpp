#include "run_verb.hpp"
#include "verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace quorient::cli {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

struct Answer : cli::Output {
    json object() const { return json::parse(out); }
};

Answer run(const std::string& arguments)
{
    Program program{"quorient", ""};
    add_design(program);
    add_layout(program);
    return Answer{run_program(program, arguments)};
}

/// A folder of its own for each test.
class Design : public testing::Test {
protected:
    Design() { std::filesystem::create_directories(folder_); }
    ~Design() override { std::filesystem::remove_all(folder_); }

    std::string written(const std::string& name, const std::string& text) const
    {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }

    const std::filesystem::path& folder() const { return folder_; }

private:
    const testing::TestInfo* test_ = testing::UnitTest::GetInstance()->current_test_info();
    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / (std::string("design_") + test_->name());
};

std::vector<std::string> keys_of(const nlohmann::ordered_json& object)
{
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

TEST(DesignVerb, has_the_fields_of_the_contract_in_order)
{
    const auto object = nlohmann::ordered_json::parse(run("design --axes 6 --json").out);
    EXPECT_THAT(keys_of(object), testing::ElementsAre("designs", "bound"));
    const auto& design = object["designs"][0];
    EXPECT_THAT(keys_of(design), testing::ElementsAre("axes", "trace", "volume", "condition", "minimum_angle_deg", "worst_after", "F_d1",
                                                      "F_d2", "survival"));
    EXPECT_THAT(keys_of(design["worst_after"][0]), testing::ElementsAre("failures", "trace", "volume", "condition"));
    EXPECT_EQ(design["axes"].size(), 6U);
    EXPECT_NEAR(design["trace"], 1.5, 1e-12);
    EXPECT_NEAR(design["minimum_angle_deg"], 63.434948823, 1e-8);
    EXPECT_EQ(design["worst_after"].size(), 2U);
    EXPECT_EQ(design["worst_after"][1]["failures"], 2);
    EXPECT_NEAR(design["worst_after"][1]["trace"], 3, 1e-9);
    EXPECT_TRUE(design["survival"].is_null());
    EXPECT_NEAR(object["bound"]["trace"], 1.5, 1e-12);
    EXPECT_NEAR(object["bound"]["worst_after"][1]["trace"], 3, 1e-12);
}

TEST(DesignVerb, judges_after_the_failures_that_are_asked_for)
{
    const auto object = run("design --axes 6 --failures 1 --json").object();
    EXPECT_EQ(object["designs"][0]["worst_after"].size(), 1U);
}

TEST(DesignVerb, prints_the_same_on_any_number_of_threads)
{
    const std::string one = run("design --axes 7 --hours 1000 --failure-rate 1e-4 --threads 1 --json").out;
    EXPECT_EQ(run("design --axes 7 --hours 1000 --failure-rate 1e-4 --threads 3 --json").out, one);
    EXPECT_NE(run("design --axes 7 --hours 1000 --failure-rate 1e-4 --threads 3 --seed 2 --json").out, one);
}

TEST(DesignVerb, plays_missions_where_hours_are_given)
{
    const auto object = run("design --axes 5 --hours 1000 --failure-rate 1e-4 --designs 1 --json").object();
    const double survival = object["designs"][0]["survival"];
    EXPECT_GT(survival, 0.8);
    EXPECT_LT(survival, 1);
}

TEST(DesignVerb, refuses_what_no_array_can_do_and_names_the_bound)
{
    const auto expect_refused = [](const std::string& arguments, const std::string& reason) {
        const Answer result = run("design " + arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments;
        EXPECT_THAT(result.error, HasSubstr(reason)) << arguments;
        EXPECT_EQ(result.out, "");
    };
    expect_refused("--axes 5 --failures 2", "6 axes are needed");
    expect_refused("--axes 5 --isolable 2", "7 axes are needed");
    expect_refused("--axes 8 --minimum-angle 60", "no 8 lines in space keep more than 54.7356 deg");
    expect_refused("--axes 2", "at least 3");
    expect_refused("--axes 4 --mounting right-angles --minimum-angle 5", "three directions");
    expect_refused("--keep triads-8 --axes 1", "at most 24");
    expect_refused("", "nothing to design");
    expect_refused("--axes 6 --objective best", "best");
    expect_refused("--axes 6 --mounting nowhere.yaml", "no mounting and no file");
    expect_refused("--axes 6 --triads 2", "--triads");
    expect_refused("--axes 6 --objective mounted_trace", "needs --mounting-error");
}

TEST(DesignVerb, gives_a_single_instrument_whatever_the_objective)
{
    for (const char* objective : {"trace", "minimum_angle", "worst_trace", "F_d1", "F_d2", "condition", "isolated_axis"}) {
        const Answer one = run(std::string("design --triads 1 --json --objective ") + objective);
        EXPECT_EQ(one.exit_code, 0) << objective << one.error;
        EXPECT_NEAR(one.object()["designs"][0]["trace"], 3, 1e-9) << objective;
    }
}

TEST_F(Design, never_names_an_array_that_measures_nothing_outside_a_plane)
{
    const std::string flat = written("flat.yaml", "kind: wedges\nangles_deg: [0]\n");  // pairs with both axes in the plate
    const Answer none = run("design --pairs 2 --mounting " + flat);
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_THAT(none.error, HasSubstr("lie in one plane"));
    EXPECT_THAT(run("design --pairs 2 --json --mounting " + flat).object()["designs"], testing::IsEmpty());
    EXPECT_EQ(run("design --triads 2 --starts 2 --mounting " + flat).exit_code, 0);
    const Answer cone = run("design --pairs 5 --mounting " + written("cone.yaml", "kind: cone\nhalf_angle_deg: 90\n"));
    EXPECT_EQ(cone.exit_code, 2);
    EXPECT_THAT(cone.error, HasSubstr("in one plane"));
}

TEST_F(Design, reports_every_mistake_of_a_brief_with_its_place)
{
    const Answer result = run(
        "design " + written("brief.yaml", "axes: 6\nmonting: free\nmounting: {kind: faces, faces: [{tolerance_deg: -1}]}\nfault: board\n"));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, AllOf(HasSubstr("brief.yaml:2:1: unknown key 'monting'; did you mean 'mounting'?"),
                                    HasSubstr("brief.yaml:3:33: mounting.faces[0].normal is missing"), HasSubstr("tolerance_deg"),
                                    HasSubstr("brief.yaml:4:8: fault: expected axis or instrument")));
}

TEST_F(Design, points_at_the_demand_of_a_brief_that_no_array_can_meet)
{
    const std::string file = written("brief.yaml", "axes: 5\nisolable: 2\n");
    EXPECT_THAT(run("design " + file).error, HasSubstr("brief.yaml:2:11: isolable: 2 simultaneous faults"));
    EXPECT_EQ(run("design " + file + " --axes 7 --json").exit_code, 0);  // options replace its values
}

TEST_F(Design, takes_every_kind_of_mounting_from_a_file)
{
    const auto trace = [&](const std::string& mounting, const std::string& what = "--axes 6") {
        const Answer result = run("design " + what + " --mounting " + written("mounting.yaml", mounting) + " --json");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return result.object()["designs"][0]["trace"].get<double>();
    };
    EXPECT_NEAR(trace("kind: symmetric\norder: 5\n"), 1.5, 1e-9);
    EXPECT_NEAR(trace("kind: mirror\nnormal: [1, 0, 0]\n"), 1.5, 1e-9);
    EXPECT_NEAR(trace("kind: cone\nhalf_angle_deg: 54.73561031724535\n"), 1.5, 1e-9);
    EXPECT_NEAR(
        trace(
            "kind: faces\nfaces:\n  - {normal: [1, 0, 0], holds: 2}\n  - {normal: [0, 1, 0], holds: 2}\n  - {normal: [0, 0, 2], holds: 2}\n"),
        1.5, 1e-9);
    EXPECT_NEAR(trace("kind: wedges\nangles_deg: [0, 90]\nazimuths_deg: [0, 90]\n"), 1.5, 1e-9);
    EXPECT_NEAR(trace("kind: wedges\nangles_deg: [0, 45]\nazimuths_deg: [0, 90, 180, 270]\nturns_deg: [0, 45]\n", "--triads 2"), 1.5, 1e-9);
}

TEST_F(Design, writes_axes_tables_and_pictures_that_the_other_verbs_take)
{
    const Answer result = run("design --triads 2 --designs 1 --out " + (folder() / "out").string());
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const auto base = (folder() / "out/design-1").string();
    const auto layout = run("layout --axes " + base + ".yaml --json").object();
    EXPECT_NEAR(layout["minimum_angle_deg"], 48.189685104, 1e-8);
    EXPECT_EQ(layout["instrument"], json({0, 0, 0, 1, 1, 1}));
    EXPECT_TRUE(std::filesystem::exists(base + ".txt"));
    std::ifstream stream(base + ".svg");
    const std::string svg{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_THAT(svg, AllOf(HasSubstr("<svg"), HasSubstr("Axes, along z"), HasSubstr("parity space"), HasSubstr("</svg>")));
    EXPECT_EQ(run("design --axes 4 --out /proc/nowhere").exit_code, 2);
}

TEST(DesignVerb, says_which_axis_may_go_at_least_cost)
{
    const auto object = run("design --keep orthogonal-3-plus-1 --remove --json").object();
    ASSERT_EQ(object["removals"].size(), 4U);
    EXPECT_EQ(object["removals"][0]["axis"], 3);  // the diagonal: three at right angles are left
    EXPECT_NEAR(object["removals"][0]["trace"], 3, 1e-12);
    const auto instruments = run("design --keep triads-8 --remove --fault instrument --json").object();
    EXPECT_EQ(instruments["removals"].size(), 8U);
    EXPECT_EQ(run("design --keep orthogonal-3 --remove").exit_code, 2);
    EXPECT_THAT(run("design --keep cone-4 --remove").out, testing::Not(HasSubstr("nan")));
}

TEST(DesignVerb, adds_axes_to_an_array_and_keeps_those_it_has)
{
    const auto object = run("design --keep cone-4 --without 3 --axes 1 --objective worst_trace --json").object();
    EXPECT_NEAR(object["designs"][0]["trace"], 2.25, 1e-9);  // the one that was left out comes back
    EXPECT_NEAR(std::abs(object["designs"][0]["axes"][3][0].get<double>()), std::sqrt(1.0 / 3), 1e-6);
}

TEST(DesignVerb, explains_in_words_what_the_winner_gains_and_what_two_failures_leave)
{
    const Answer result = run("design --axes 6 --explain");
    EXPECT_THAT(result.out, AllOf(HasSubstr("It is the layout `dodecahedron`"),
                                  HasSubstr("Against three at right angles plus one:\n    costs  2 axes more"),
                                  HasSubstr("WHAT TWO FAILURES LEAVE"), HasSubstr("met: no array does better")));
    EXPECT_EQ(run("design --axes 4 --explain").exit_code, 0);
    EXPECT_EQ(run("design --axes 3 --explain").exit_code, 0);
    EXPECT_THAT(run("design --triads 2 --explain").out, HasSubstr("122 % from a bound"));  // F_d2: 2.25 of 5
    EXPECT_THAT(run("design --axes 7 --mounting right-angles --starts 2 --explain").out, testing::Not(HasSubstr("inf ")));  // two axes are parallel
}

TEST(DesignVerb, says_so_where_parity_cannot_name_the_failures)
{
    const Answer aligned = run("design --axes 6 --failures 1 --mounting right-angles --json");
    EXPECT_EQ(aligned.exit_code, 0);
    EXPECT_THAT(aligned.error, HasSubstr("lets parity name 1 failures"));
    EXPECT_THAT(run("design --axes 6 --failures 1 --json").error, testing::Not(HasSubstr("parity name")));
    EXPECT_THAT(run("design --triads 2 --mounting right-angles --explain").out, HasSubstr("one sample there names the axis of a fault"));
}

TEST(DesignVerb, ends_with_1_and_the_nearest_array_where_none_meets_the_demands)
{
    const Answer result = run("design --axes 8 --minimum-angle 54 --starts 4");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, HasSubstr("NO ARRAY FOUND"));
    EXPECT_THAT(run("design --axes 8 --minimum-angle 54 --starts 4 --json").object()["designs"], testing::IsEmpty());
}

TEST(LayoutVerb, prints_the_figures_that_design_compares)
{
    const Answer text = run("layout dodecahedron --design");
    EXPECT_THAT(text.out, AllOf(HasSubstr("worst after 2: trace"), HasSubstr("one fault isolated, sigma")));
    const auto object = run("layout dodecahedron --design --json").object();
    EXPECT_NEAR(object["design"]["worst_after"][1]["trace"], 3, 1e-12);
    EXPECT_NEAR(object["design"]["detected_axis_sigma"], 10.9, 0.05);
    EXPECT_FALSE(run("layout dodecahedron --json").object().contains("design"));
}

}  // namespace
}  // namespace quorient::cli
