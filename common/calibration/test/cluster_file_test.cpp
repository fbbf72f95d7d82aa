#include "quorient/calibration/cluster_file.hpp"

#include "quorient/messages/name.hpp"
#include "synthetic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::calibration {
namespace {

using testing::HasSubstr;

CalibratedCluster some_cluster()
{
    std::mt19937_64 random(9);
    const Truth truth = three_triads(random);
    CalibratedCluster cluster;
    cluster.description = nominal_description();
    std::copy_n("a board", 7, cluster.description.name.begin());
    for (std::size_t axis = 0; axis < 9; ++axis) {
        const auto row = static_cast<Eigen::Index>(axis);
        Eigen::Vector3d::Map(cluster.description.axis[axis].data()) = truth.axes.row(row);
        cluster.description.bias[axis] = truth.bias_rad_s(row);
        cluster.description.sigma[axis] = 1e-5 / 3;
        cluster.gain[axis] = truth.gain(row);
    }
    cluster.jitter.along_s = 1.0 / 3e3;
    cluster.motion_level = 4.0 / 3;
    cluster.gated = {.jitter_along_s = 1.0 / 7e3, .jitter_across_s = 1.0 / 9e3, .axes_error = 1e-3 / 3, .rate_error = 1e-4 / 3};
    cluster.origin = "log \"one\".bin";
    return cluster;
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return text.replace(place, from.size(), to);
}

TEST(ClusterFile, reads_back_bit_for_bit)
{
    const CalibratedCluster cluster = some_cluster();
    const std::string text = to_yaml(cluster);
    const auto read = parse_cluster(text, "cluster.yaml");
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(to_yaml(*read), text);
    EXPECT_EQ(read->description.axis, cluster.description.axis);
    EXPECT_EQ(read->description.bias, cluster.description.bias);
    EXPECT_EQ(read->description.instrument, cluster.description.instrument);
    EXPECT_EQ(read->description.instrument_count, 3);
    EXPECT_EQ(read->gain, cluster.gain);
    EXPECT_EQ(read->jitter.along_s, cluster.jitter.along_s);
    EXPECT_EQ(read->motion_level, cluster.motion_level);
    ASSERT_TRUE(read->gated);
    EXPECT_EQ(read->gated->jitter_across_s, cluster.gated->jitter_across_s);
    EXPECT_EQ(read->gated->rate_error, cluster.gated->rate_error);
    EXPECT_EQ(read->origin, cluster.origin);
}

TEST(ClusterFile, may_not_know_how_wild_the_motion_noise_is)
{
    CalibratedCluster cluster = some_cluster();
    cluster.motion_level = 0;
    const auto read = parse_cluster(replaced(to_yaml(cluster), ", level: 0", ""), "cluster.yaml");
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(read->motion_level, 0);
}

TEST(ClusterFile, has_gated_terms_all_or_none)
{
    CalibratedCluster cluster = some_cluster();
    const auto lacking = parse_cluster(replaced(to_yaml(cluster), ", axes: ", ", rates: "), "cluster.yaml");
    ASSERT_FALSE(lacking);
    EXPECT_THAT(lacking.error(), AllOf(HasSubstr("unknown key 'rates'"), HasSubstr("motion_noise.gated.axes is missing")));
    cluster.gated.reset();
    const auto without = parse_cluster(to_yaml(cluster), "cluster.yaml");
    ASSERT_TRUE(without) << without.error();
    EXPECT_FALSE(without->gated);
}

TEST(ClusterFile, names_every_problem_with_its_place)
{
    std::string text = to_yaml(some_cluster());
    text = replaced(text, "along_s", "allong_s");
    text = replaced(text, "gain: 1", "gain: -1");
    text = replaced(text, "kind: gyro", "kind: compass");
    const auto read = parse_cluster(text, "cluster.yaml");
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error(), AllOf(HasSubstr("cluster.yaml:4:7: kind: unknown kind 'compass'; there is gyro"),
                                    HasSubstr("cluster.yaml:7:16: unknown key 'allong_s' in motion_noise; did you mean 'along_s'?"),
                                    HasSubstr("motion_noise.along_s is missing"), HasSubstr("axes[0].gain: must be at least 0.1, got -1")));
}

TEST(ClusterFile, refuses_axes_that_no_cluster_can_have)
{
    const std::string good = to_yaml(some_cluster());
    const auto error = [](const std::string& text) { return parse_cluster(text, "c").error(); };
    EXPECT_THAT(error(replaced(good, "direction: [", "direction: [9")), HasSubstr("norm"));
    EXPECT_THAT(error(replaced(good, "direction: [", "direction: [0, ")), HasSubstr("[x, y, z]"));
    EXPECT_THAT(error(replaced(good, "sigma_rad: 3", "sigma_rad: .nan, position_m: [0, 0, 0], quantum_rad: 3")),
                HasSubstr("axes[0].sigma_rad: expected a number [rad], got '.nan'"));
    EXPECT_THAT(error("axes: [1, 2, 3]"), HasSubstr("axes[0] must be a mapping of keys to values, got '1'"));
    EXPECT_THAT(error(""), HasSubstr("expected keys"));
    EXPECT_THAT(error("axes: ["), HasSubstr("c:1"));
    EXPECT_THAT(error("[]"), HasSubstr("expected a mapping of keys to values"));
    EXPECT_FALSE(load_cluster("/nowhere.yaml"));
}

TEST(ClusterFile, refuses_names_that_a_message_would_not_end_with_a_zero)
{
    const std::string named = replaced(to_yaml(some_cluster()), R"(instrument: "IMU1")", "instrument: fifteen_letters");
    const std::string good = replaced(named, R"("a board")", std::string(31, 'b'));
    const auto read = parse_cluster(good, "c");
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(read->description.instrument_name[0].back(), '\0');
    EXPECT_EQ(read->description.name.back(), '\0');
    const auto longer = parse_cluster(replaced(replaced(good, "fifteen_letters", "sixteen__letters"), "bbb", "bbbb"), "c");
    ASSERT_FALSE(longer);
    EXPECT_THAT(longer.error(), AllOf(HasSubstr("axes[0].instrument: must be a text of at most 15 bytes"),
                                      HasSubstr("name: must be a text of at most 31 bytes")));
}

TEST(ClusterFile, of_a_publisher_whose_names_are_full_reads_back)
{
    CalibratedCluster cluster = some_cluster();
    cluster.description.name.fill('b');
    cluster.description.instrument_name[0].fill('i');
    const auto read = parse_cluster(to_yaml(cluster), "c");
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(text_of(read->description.name), std::string(31, 'b'));
    EXPECT_EQ(text_of(read->description.instrument_name[0]), std::string(15, 'i'));
}

TEST(ClusterFile, survives_any_damage)
{
    const std::string good = to_yaml(some_cluster());
    const unsigned seed = 20240614;
    std::mt19937 random(seed);
    for (int trial = 0; trial < 300; ++trial) {
        std::string text = good;
        for (int damage = 0; damage < 4; ++damage) text[random() % text.size()] = static_cast<char>(random() % 128);
        text.resize(text.size() - random() % 200);
        const auto read = parse_cluster(text, "c");
        if (read) {
            EXPECT_GE(read->description.axis_count, 3) << "seed " << seed << " trial " << trial;
        } else {
            EXPECT_FALSE(read.error().empty());
        }
    }
}

}  // namespace
}  // namespace quorient::calibration
