#include "judges.hpp"
#include "study.hpp"

#include "quorient/geometry/layouts.hpp"

#include <gtest/gtest.h>
#include <cmath>

namespace quorient::studies {
namespace {

Scene scene(const char* layout, const Faults& faults, std::vector<JudgeFactory> judges)
{
    return {geometry::layout(layout).value(), faults, true, std::move(judges)};
}

JudgeFactory subset_method()
{
    fdi::DetectorSettings settings;
    settings.method = "subset";
    settings.sigma = 1;
    settings.pfa = 1e-3;
    settings.max_faults = 2;
    settings.margin = 0;
    return method(settings);
}

std::vector<Scene> two_scenes()
{
    return {scene("dodecahedron", {1, 5, 30}, {subset_method(), likelihood_of_known_count()}),
            scene("cone-6", {2, 20, 200}, {subset_method(), voting_by_component(4)})};
}

TEST(MonteCarlo, gives_the_same_counts_on_any_number_of_threads)
{
    const auto one = run(two_scenes(), {3500, 7, 1});
    for (const unsigned threads : {2U, 5U}) EXPECT_EQ(run(two_scenes(), {3500, 7, threads}), one) << threads << " threads";
    EXPECT_EQ(one[0][0].trials(), 3500U);
}

TEST(MonteCarlo, gives_other_counts_with_another_seed_and_in_another_block)
{
    const auto first = run(two_scenes(), {1000, 7, 1});
    EXPECT_NE(run(two_scenes(), {1000, 8, 1}), first);
    const auto twice = run(two_scenes(), {2000, 7, 1});
    EXPECT_NE(twice[0][0].correct, 2 * first[0][0].correct);
}

TEST(MonteCarlo, tells_its_progress_block_by_block)
{
    std::vector<std::size_t> seen;
    run(two_scenes(), {2500, 1, 2}, [&seen](std::size_t done, std::size_t all) {
        EXPECT_EQ(all, 6U);
        seen.push_back(done);
    });
    EXPECT_EQ(seen, (std::vector<std::size_t>{1, 2, 3, 4, 5, 6}));
}

// Recomputed rates; four standard errors of 20 000 trials here and 6000 there.
TEST(MonteCarlo, finds_the_published_rates)
{
    const auto expect_near = [](const Tally& tally, double published) {
        const Rate ours = rate(tally.correct, tally.trials());
        const double theirs = std::sqrt(published * (100 - published) / 6000);
        EXPECT_NEAR(ours.percent, published, 4 * std::hypot(ours.error, theirs) + 0.1);
    };
    const auto tallies = run({scene("dodecahedron", {2, 5, 30}, {subset_method(), likelihood_of_known_count(), posterior_of_known_count()}),
                              scene("cone-6", {1, 5, 30}, {subset_method(), voting_by_component(4)})},
                             {20'000, 3, 0});
    expect_near(tallies[0][0], 64.9);
    expect_near(tallies[0][1], 70.6);
    expect_near(tallies[0][2], 74.7);
    expect_near(tallies[1][0], 96.3);
    expect_near(tallies[1][1], 47.2);
}

TEST(KnownCount, is_never_wrong_without_noise_and_undecided_without_faults)
{
    auto quiet = scene("dodecahedron", {2, 5, 30}, {likelihood_of_known_count()});
    quiet.noisy = false;
    EXPECT_EQ(run({quiet}, {2000, 1, 1})[0][0].correct, 2000U);
    EXPECT_EQ(run({scene("dodecahedron", {}, {likelihood_of_known_count()})}, {100, 1, 1})[0][0].flagged, 100U);
}

TEST(Tally, keeps_wrong_missed_and_flagged_apart)
{
    Tally tally;
    tally.count({true, 0b01}, 0b01);
    tally.count({true, 0b10}, 0b01);
    tally.count({true, 0}, 0b01);
    tally.count({false, 0b01}, 0b01);
    tally.count({true, 0}, 0);
    EXPECT_EQ(tally, (Tally{2, 1, 1, 1}));
}

TEST(Paper002, is_within_one_and_a_half_points_of_every_printed_figure)
{
    const Report report = paper_002({40'000, 5, 0}, {});
    EXPECT_EQ(report.json["figures"].size(), 15U);
    for (const auto& figure : report.json["figures"]) EXPECT_NEAR(figure["difference"].get<double>(), 0, 1.5) << figure["figure"];
    EXPECT_EQ(report.json["not_reproducible"].size(), 2U);
}

TEST(Ceiling, is_within_the_published_rounding)
{
    const Report report = ceiling({20'000, 5, 0}, {});
    for (const auto& row : report.json["layouts"]) {
        EXPECT_NEAR(row["size_sigma"].get<double>(), row["published_size_sigma"].get<double>(), 0.1) << row["layout"];
        EXPECT_GT(row["detected_percent"].get<double>(), 99 - 4 * row["detected_error"].get<double>()) << row["layout"];
        EXPECT_NEAR(row["isolated_at_10_sigma"].get<double>(), row["published_isolated"].get<double>(), 0.03) << row["layout"];
    }
}

}  // namespace
}  // namespace quorient::studies
