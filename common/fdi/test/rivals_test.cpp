#include "field_scene.hpp"
#include "quorient/fdi/methods.hpp"
#include "single_frame/combinations.hpp"
#include "test_clusters.hpp"

#include <Eigen/QR>
#include <gtest/gtest.h>

// "A detector isolates a set of axes only if no other set of the same size or smaller explains the data": judged here by least squares
// without the axes of each set, independently of every method.

namespace quorient::fdi {

namespace {

constexpr double explained = 1e-9;  // beside faults of 0.05 and more

/// What is left of z where these axes are not asked.
double left_without(const geometry::SensorCluster& cluster, const std::vector<double>& z, AxisMask without)
{
    const Eigen::Index kept = static_cast<Eigen::Index>(cluster.size()) - std::popcount(without);
    Eigen::MatrixXd rows(kept, 3);
    Eigen::VectorXd values(kept);
    Eigen::Index row = 0;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        if (has_axis(without, axis)) continue;
        rows.row(row) = cluster.axes.row(static_cast<Eigen::Index>(axis));
        values(row++) = z[axis];
    }
    const Eigen::VectorXd estimate = rows.colPivHouseholderQr().solve(values);
    return (values - rows * estimate).norm();
}

bool has_rival(const geometry::SensorCluster& cluster, const std::vector<double>& z, AxisMask named)
{
    bool rival = false;
    for (std::size_t size = 1; size <= static_cast<std::size_t>(std::popcount(named)); ++size)
        for_each_subset(cluster.all(), size, [&](AxisMask set) { rival = rival || (set != named && left_without(cluster, z, set) < explained); });
    return rival;
}

struct Case {
    std::string method;
    std::string layout;
    bool relaxed = false;
};

DetectorSettings settings_of(const Case& its)
{
    DetectorSettings settings;
    settings.method = its.method;
    settings.relaxed = its.relaxed;
    settings.max_faults = 2;
    if (its.method == "guaranteed") {
        settings.bound = 1e-5;
        settings.threshold = 1e-4;
    } else if (its.method == "glt" || its.method == "parity-set" || its.method == "subset") settings.sigma = 1e-5;
    else settings.tolerance = 1e-4;
    return settings;
}

std::vector<Case> cases()
{
    std::vector<Case> all;
    for (const Method& method : methods())
        if (method.input == MethodInput::row)
            for (const char* layout : {"dodecahedron", "octahedron-8"}) {
                all.push_back({std::string(method.word), layout});
                if (method.word == "invariants") all.push_back({std::string(method.word), layout, true});
            }
    return all;
}

class Rivals : public testing::TestWithParam<Case> {};

TEST_P(Rivals, are_looked_for_before_an_axis_is_named)
{
    const auto cluster = cluster_named(GetParam().layout);
    const auto detector = make_detector(settings_of(GetParam()), cluster).value();
    unsigned named = 0;
    for_each_subset(cluster.all(), 2, [&](AxisMask faulty) {
        const MaskMembers axes(faulty);
        for (const double ratio : {-1.0, 1.0, 0.0, 0.37}) {
            const auto z = measure(cluster, {0.01, -0.02, 0.015}, {{axes.item[0], -0.05}, {axes.item[1], -0.05 * ratio}});
            const auto assessment = assess(*detector, z);
            if (assessment.outcome != Outcome::isolated) continue;
            ++named;
            EXPECT_FALSE(has_rival(cluster, z, assessment.isolated))
                << "faults on axes " << int{axes.item[0]} << " and " << int{axes.item[1]} << ", ratio " << ratio;
        }
    });
    EXPECT_GT(named, 0U) << "a method that names nobody keeps any promise";
}

INSTANTIATE_TEST_SUITE_P(Methods, Rivals, testing::ValuesIn(cases()), [](const auto& its) {
    std::string name = its.param.method + "_" + its.param.layout + (its.param.relaxed ? "_relaxed" : "");
    std::ranges::replace(name, '-', '_');
    return name;
});

TEST(RivalsOfTheBareRule, are_not_seen)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto z = measure(cluster, {0.01, -0.02, 0.015}, {{2, -0.05}, {3, -0.05}});
    for (Case its : {Case{"mean", "dodecahedron"}, Case{"invariants", "dodecahedron", true}}) {
        auto settings = settings_of(its);
        EXPECT_EQ(assess(*make_detector(settings, cluster).value(), z).outcome, Outcome::ambiguous) << its.method;
        settings.bare = true;
        const auto bare = assess(*make_detector(settings, cluster).value(), z);
        EXPECT_EQ(bare.outcome, Outcome::isolated) << its.method;
        EXPECT_TRUE(has_rival(cluster, z, bare.isolated)) << its.method;
    }
}

// Methods that compare whole instruments: some of them read the same constant too much. Those that are left are consistent where all of them are
// faulty alike or all are sound, and where at least two are left.

struct Several {
    std::string method;
    std::size_t instruments;
};

std::vector<Several> several()
{
    std::vector<Several> all;
    for (const Method& method : methods())
        if (method.input == MethodInput::instruments)
            for (const std::size_t count : {3, 4, 5}) all.push_back({std::string(method.word), count});
    return all;
}

using InstrumentSet = std::uint32_t;

bool explains(InstrumentSet without, InstrumentSet faulty, std::size_t count)
{
    const InstrumentSet left = ((InstrumentSet{1} << count) - 1) & ~without;
    return std::popcount(left) >= 2 && ((left & faulty) == 0 || (left & ~faulty) == 0);
}

InstrumentSet instruments_of(AxisMask axes)
{
    InstrumentSet set = 0;
    for (std::size_t axis = 0; axis < max_axes; ++axis)
        if (has_axis(axes, axis)) set |= InstrumentSet{1} << axis / 3;
    return set;
}

class RivalInstruments : public testing::TestWithParam<Several> {};

TEST_P(RivalInstruments, are_looked_for_before_an_instrument_is_named)
{
    constexpr std::uint64_t seed = 3;
    constexpr double onset_s = 5, end_s = 8, size_deg_s = 40;
    const auto [method, count] = GetParam();
    unsigned named = 0;
    for (InstrumentSet faulty = 1; faulty + 1 < InstrumentSet{1} << count; ++faulty) {
        FieldScene scene(count, seed, {.bias_deg_s = 0, .gain = 0, .delay_s = 0, .drift_deg_s = 0, .jitter_s = 0});
        scene.cluster.sigma.setConstant(0.1 * degree * scene.cluster.interval_s);
        scene.spoil = [&](std::uint64_t, FieldScene::Rates& rates) {
            for (std::size_t m = 0; m < count && scene.time_s() >= onset_s; ++m)
                if (faulty >> m & 1) rates[3 * m] += size_deg_s;
        };
        DetectorSettings settings;
        settings.method = method;
        const auto detector = make_detector(settings, scene.cluster).value();
        Assessment assessment;
        while (scene.time_s() < end_s) {
            detector->assess(scene.next(), assessment);
            if (assessment.outcome != Outcome::isolated) continue;
            ++named;
            const InstrumentSet own = instruments_of(assessment.isolated);
            for (InstrumentSet rival = 1; rival < InstrumentSet{1} << count; ++rival)
                ASSERT_FALSE(rival != own && std::popcount(rival) <= std::popcount(own) && explains(rival, faulty, count))
                    << "faulty " << faulty << ", named " << own << ", rival " << rival << " at " << scene.time_s() << " s, seed " << seed;
        }
    }
    EXPECT_GT(named, 0U) << "a method that names nobody keeps any promise";
}

INSTANTIATE_TEST_SUITE_P(Methods, RivalInstruments, testing::ValuesIn(several()),
                         [](const auto& its) { return its.param.method + "_" + std::to_string(its.param.instruments); });

}  // namespace

}  // namespace quorient::fdi
