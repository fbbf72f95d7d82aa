// The study `field` on simulated and recorded logs.

#include "field_trial.hpp"

#include "data_folder.hpp"
#include "quorient/messages/units.hpp"

#include <gtest/gtest.h>

namespace quorient::studies {
namespace {

std::filesystem::path data_dir()
{
    return recording::data_folder(QUORIENT_SOURCE_DIR);
}

fdi::FaultMonitor monitor_on(const FieldLog& log, fdi::Mount mount = fdi::Mount::board)
{
    fdi::DetectorSettings settings{.method = "field"};
    settings.mount = mount;
    return fdi::FaultMonitor::make(settings, {}, log.cluster).value();
}

struct Recorded {
    const char* file;
    fdi::Mount mount = fdi::Mount::board;
};

std::ostream& operator<<(std::ostream& out, const Recorded& recorded)
{
    return out << recorded.file;
}

class SoundLog : public ::testing::TestWithParam<Recorded> {
protected:
    void SetUp() override
    {
        const auto file = data_dir() / GetParam().file;
        if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: set QUORIENT_DATA_DIR to the folder of recordings";
        auto loaded = load_field_log(file);
        ASSERT_TRUE(loaded) << loaded.error();
        log = std::move(*loaded);
    }

    FieldLog log;
};

TEST_P(SoundLog, blames_no_sound_instrument_without_any_calibration)
{
    for (const auto& set : instrument_sets(log.instruments())) {
        const FieldLog part = part_of(log, set);
        const SoundRun run = play_sound(part, monitor_on(part, GetParam().mount));
        EXPECT_EQ(run.latched, 0U) << part.name << " at " << run.first_latched_s << " s";
        EXPECT_LE(run.provisional_s, 0.03 * part.duration_s()) << part.name;
    }
}

TEST_P(SoundLog, names_a_bias_of_10_deg_s_soon_and_nobody_else)
{
    const FieldLog part = part_of(log, instrument_sets(log.instruments()).back());
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 4; ++trial) {
        const Injection injection = draw(part, {.name = "bias 10", .spoil = Spoil::bias, .size = 10 * degree, .kind = Diagnosis::bias}, 0, random);
        const FaultRun run = play_fault(part, injection, 1, monitor_on(part, GetParam().mount));
        EXPECT_EQ(run.wrong, 0U) << run.injected;
        EXPECT_LE(run.protected_s, 1.0) << run.injected;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, SoundLog,
                         ::testing::Values(Recorded{"field/cats_drone_healthy.csv"},
                                           Recorded{"field/cats_rocket_healthy_long.csv"}, Recorded{"field/ardupilot_3_imus_crash.bin"},
                                           Recorded{"field/rover_5_imus", fdi::Mount::structure}),
                         [](const auto& tested) {
                             std::string name = std::filesystem::path(tested.param.file).stem().string();
                             return name;
                         });

/// Here a faulty instrument looked like noise of the two sound ones, one of which was blamed.
TEST(RocketLog, blames_no_other_instrument_for_a_sign_that_changes_in_the_tumble)
{
    const auto file = data_dir() / "field/cats_rocket_healthy_long.csv";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: set QUORIENT_DATA_DIR to the folder of recordings";
    const auto log = load_field_log(file);
    ASSERT_TRUE(log) << log.error();
    constexpr std::size_t frames_per_s = 100;
    for (const double onset_s : {14.0, 14.23, 14.27, 18.8, 18.9, 18.95, 19.0, 19.1}) {
        const Injection injection{.fault = {.name = "sign", .spoil = Spoil::sign, .kind = Diagnosis::sign},
                                  .instrument = 0,
                                  .axis = 1,
                                  .onset = static_cast<std::size_t>(onset_s * frames_per_s)};
        const FaultRun run = play_fault(*log, injection, 1, monitor_on(*log));
        EXPECT_EQ(run.wrong, 0U) << onset_s;
        EXPECT_TRUE(std::isfinite(run.latched_s)) << onset_s;
    }
}

class SoftAxis : public ::testing::TestWithParam<const char*> {};

TEST_P(SoftAxis, of_a_real_board_is_named_with_its_gain_and_no_other_instrument)
{
    const auto file = data_dir() / "field" / GetParam();
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: set QUORIENT_DATA_DIR to the folder of recordings";
    const auto log = load_field_log(file);
    ASSERT_TRUE(log) << log.error();
    const SoundRun run = play_sound(*log, monitor_on(*log));
    EXPECT_EQ(run.latched, log->cluster.axes_of(0));
    EXPECT_EQ(run.diagnosis.diagnosis[2], static_cast<std::uint8_t>(Diagnosis::gain));
    EXPECT_NEAR(run.diagnosis.size[2], 0.455, 0.045) << "0.44 to 0.47 by the description of the data, within 0.03";
}

INSTANTIATE_TEST_SUITE_P(Of, SoftAxis, ::testing::Values("cats_drone_soft_axis_1.csv", "cats_drone_soft_axis_2.csv"),
                         [](const auto& tested) { return std::filesystem::path(tested.param).stem().string(); });

}  // namespace
}  // namespace quorient::studies
