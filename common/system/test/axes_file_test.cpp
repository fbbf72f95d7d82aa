#include "quorient/system/axes_file.hpp"
#include "quorient/system/system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>

namespace quorient::system {
namespace {

using testing::HasSubstr;

/// A folder of its own for each test.
class AxesFile : public testing::Test {
protected:
    AxesFile() { std::filesystem::create_directories(folder_); }
    ~AxesFile() override { std::filesystem::remove_all(folder_); }

    std::string written(const std::string& name, const std::string& text) const
    {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }

    std::string problem_with(const std::string& text) const { return load_axes_file(written("axes.yaml", text)).error(); }

private:
    const testing::TestInfo* test_ = testing::UnitTest::GetInstance()->current_test_info();
    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / (std::string("axes_file_") + test_->name());
};

TEST_F(AxesFile, gives_axes_and_instruments)
{
    const auto cluster = load_axes_file(
        written("axes.yaml", "axes:\n  - [1, 0, 0]\n  - [0, 1, 0]\n  - [0, 0, 1]\n  - [0, 0.6, 0.8]\ninstrument: [0, 0, 0, 1]\n"));
    ASSERT_TRUE(cluster) << cluster.error();
    EXPECT_EQ(cluster->size(), 4U);
    EXPECT_EQ(cluster->axes(3, 1), 0.6);
    EXPECT_EQ(cluster->instrument, (std::vector<std::size_t>{0, 0, 0, 1}));
}

TEST_F(AxesFile, says_where_it_is_wrong)
{
    EXPECT_THAT(problem_with("axes:\n  - [1, 0, 0]\n  - [0, 1]\n  - [0, 0, x]\n"),
                testing::AllOf(HasSubstr("axes.yaml:3:5: axis 1 must be [x, y, z]"), HasSubstr("axes.yaml:4:12: axis 2 has a component")));
    EXPECT_THAT(problem_with("axes:\n  - [1, 0, 0]\n  - [0, 2, 0]\n  - [0, 0, 1]\n"), HasSubstr("axes.yaml:3:5: axis 1: norm 2"));
    EXPECT_THAT(problem_with("axes:\n  - [1, 0, 0]\n  - [0, 1, 0]\n  - [0, 0, 1]\ninstruments: [0, 1, 2]\n"),
                HasSubstr("did you mean 'instrument'?"));
    EXPECT_THAT(problem_with("directions: []\n"), HasSubstr("expected `axes`"));
    EXPECT_THAT(problem_with("axes:\n  - [1, 0, 0]\n  - [0, 1, 0]\n  - [0.6, 0.8, 0]\n"), HasSubstr("all lie in one plane"));
}

TEST_F(AxesFile, is_taken_by_a_system_file_from_its_own_folder)
{
    written("tetrad.yaml", "axes:\n  - [1, 0, 0]\n  - [0, 1, 0]\n  - [0, 0, 1]\n  - [0.48, 0.64, 0.6]\n");
    const std::string lanes = "lanes:\n  - name: a\nvoters:\n  - name: v\n";
    const auto system = load(written("system.yaml", "unit: {axes: tetrad.yaml}\nsource: {kind: simulation, noise_rad: 1e-6}\n" + lanes));
    ASSERT_TRUE(system) << system.error();
    EXPECT_EQ(system->sensor.cluster->size(), 4U);
    EXPECT_EQ(system->sensor.cluster->axes(3, 2), 0.6);

    const auto missing = load(written("system.yaml", "unit: {axes: absent.yaml}\nsource: {kind: simulation, noise_rad: 1e-6}\n" + lanes));
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error(), testing::AllOf(HasSubstr("system.yaml:1:14"), HasSubstr("absent.yaml: cannot be read")));
}

}  // namespace
}  // namespace quorient::system
