#include "observer_scene.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <random>

using namespace quorient;
using namespace quorient::fdi;
using namespace quorient::fdi::test;

TEST(ObserverDetector, isolates_every_sample_of_both_faults_by_the_blind_scheme)
{
    for (const double noise : {0.0, 2e-4}) {
        auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
        int right_gyro = 0, right_acc = 0, alarms = 0;
        PaperRun run;
        run.noise = noise;
        follow(run, *detector, [&](double time, const Assessment& assessment) {
            const bool gyro = time >= 26 && time < 30, acc = time >= 60 && time < 70, quiet = time >= 5 && time < 20;
            right_gyro += gyro && assessment.outcome == Outcome::isolated && assessment.isolated == 0b10 ? 1 : 0;
            right_acc += acc && assessment.outcome == Outcome::isolated && assessment.isolated == 0b01 ? 1 : 0;
            alarms += quiet && assessment.outcome != Outcome::healthy ? 1 : 0;
        });
        EXPECT_EQ(right_gyro, 400) << "noise " << noise;
        EXPECT_EQ(right_acc, 1000) << "noise " << noise;
        EXPECT_EQ(alarms, 0) << "noise " << noise;
    }
}

TEST(ObserverDetector, never_names_the_wrong_channel_while_the_directions_form)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::directional), 0.01).value();
    int right_gyro = 0, right_acc = 0, wrong = 0, seen_at_once = 0;
    follow(PaperRun{}, *detector, [&](double time, const Assessment& assessment) {
        const bool gyro = time >= 20 && time < 30, acc = time >= 50 && time < 70;
        right_gyro += gyro && assessment.isolated == 0b10 ? 1 : 0;
        right_acc += acc && assessment.isolated == 0b01 ? 1 : 0;
        wrong += (gyro && assessment.isolated == 0b01) || (acc && assessment.isolated == 0b10) ? 1 : 0;
        const bool onset = (time > 19.995 && time < 20.005) || (time > 49.995 && time < 50.005);
        seen_at_once += onset && assessment.outcome == Outcome::suspect ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(seen_at_once, 2) << "detection does not wait for attribution";
    EXPECT_GT(right_gyro, 740);
    EXPECT_GT(right_acc, 1740);
}

TEST(ObserverDetector, raises_no_alarm_without_a_fault)
{
    for (const auto scheme : {ObserverScheme::directional, ObserverScheme::blind}) {
        auto settings = paper_settings(scheme);
        settings.threshold.reset();
        settings.sigma = {2e-4};
        settings.false_alarm_probability = 1e-4;
        int alarms = 0, frames = 0;
        for (unsigned seed = 1; seed <= 20; ++seed) {
            auto detector = ObserverDetector::make(settings, 0.01).value();
            PaperRun run;
            run.noise = 2e-4;
            run.seed = seed;
            run.gyro_fault = run.accelerometer_fault = 0;
            follow(run, *detector, [&](double, const Assessment& assessment) {
                ++frames;
                alarms += assessment.outcome != Outcome::healthy ? 1 : 0;
            });
        }
        EXPECT_LE(alarms, 1.5e-4 * frames) << to_string(scheme) << ": 1e-4 were allowed";
    }
}

TEST(ObserverDetector, raises_alarms_as_often_as_it_was_allowed_to)
{
    auto settings = paper_settings(ObserverScheme::blind);
    settings.threshold.reset();
    settings.sigma = {2e-4};
    settings.false_alarm_probability = 0.02;
    int alarms = 0, frames = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        auto detector = ObserverDetector::make(settings, 0.01).value();
        PaperRun run;
        run.noise = 2e-4;
        run.seed = seed;
        run.gyro_fault = run.accelerometer_fault = run.rudder_rad = 0;
        follow(run, *detector, [&](double, const Assessment& assessment) {
            ++frames;
            alarms += assessment.outcome != Outcome::healthy ? 1 : 0;
        });
    }
    EXPECT_NEAR(alarms / static_cast<double>(frames), 0.02, 0.003) << "the quantile and the residual's variance are right";
}

TEST(ObserverDetector, survives_a_model_that_is_wrong_by_what_it_was_told)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> error(-0.05, 0.05);
    int alarms_told = 0, alarms_untold = 0, isolated = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        PaperRun run;
        run.noise = 2e-4;
        run.seed = seed;
        run.plant.a = run.plant.a.unaryExpr([&](double value) { return value * (1 + error(random)); });
        run.plant.b = run.plant.b.unaryExpr([&](double value) { return value * (1 + error(random)); });
        run.gyro_fault = run.accelerometer_fault = 0;
        auto settings = paper_settings(ObserverScheme::blind);
        settings.threshold.reset();
        settings.sigma = {2e-4};
        settings.false_alarm_probability = 1e-5;
        const auto count = [&](const PaperRun& played, auto predicate) {
            auto detector = ObserverDetector::make(settings, 0.01).value();
            int found = 0;
            follow(played, *detector, [&](double time, const Assessment& assessment) { found += predicate(time, assessment) ? 1 : 0; });
            return found;
        };
        const auto alarm = [](double, const Assessment& assessment) { return assessment.outcome != Outcome::healthy; };
        alarms_untold += count(run, alarm);
        settings.model_error = 0.05;
        alarms_told += count(run, alarm);
        run.gyro_fault = 0.03;
        isolated +=
            count(run, [](double time, const Assessment& assessment) { return time >= 20 && time < 30 && assessment.isolated == 0b10; });
    }
    EXPECT_LE(alarms_told, 8) << "of 320000 samples at 1e-5";
    EXPECT_GT(alarms_untold, 100) << "the bound is what it takes";
    EXPECT_GT(isolated, 40 * 1000 * 0.9) << "and a fault of 0.03 is still found";
}

TEST(ObserverDetector, goes_on_detecting_with_the_channel_that_is_left)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
    EXPECT_EQ(detector->detectable_remaining(), 1U);
    detector->exclude(0b10);
    EXPECT_EQ(detector->detectable_remaining(), 1U);
    int named = 0, alarms = 0;
    follow(PaperRun{}, *detector, [&](double time, const Assessment& assessment) {
        EXPECT_EQ(assessment.isolated & 0b10U, 0U) << "an excluded channel is not blamed";
        named += time >= 50 && time < 70 && assessment.isolated == 0b01 ? 1 : 0;
        const bool learning = time < 2.31 && assessment.outcome == Outcome::warming_up;
        alarms += time < 50 && assessment.outcome != Outcome::healthy && !learning ? 1 : 0;
    });
    EXPECT_EQ(named, 2000);
    EXPECT_EQ(alarms, 0) << "not even while the excluded channel is faulty";
    detector->exclude(0b11);
    EXPECT_EQ(detector->detectable_remaining(), 0U);
}

TEST(ObserverDetector, isolates_two_channels_of_five)
{
    std::mt19937 random(5);
    std::normal_distribution<double> gauss;
    LinearPlant plant{Eigen::MatrixXd{{-0.5, 1, 0}, {-1, -0.5, 0.3}, {0, 0, -0.8}}, Eigen::Vector3d(0, 1, 1),
                      Eigen::MatrixXd::NullaryExpr(5, 3, [&] { return gauss(random); })};
    ObserverSettings settings;
    settings.plant = plant;
    settings.poles = {{-2, -2.5, -3}};
    settings.threshold = 1e-3;
    for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = i; j < 5; ++j) {
            auto detector = ObserverDetector::make(settings, 0.01).value();
            const auto hold = geometry::zero_order_hold(plant.a, plant.b, 0.01);
            Eigen::VectorXd state = Eigen::VectorXd::Zero(3);
            Assessment assessment;
            for (std::uint64_t k = 0; k < 1000; ++k) {
                const double input = 0.01 * std::sin(0.01 * static_cast<double>(k));
                Eigen::VectorXd sample = plant.c * state;
                if (k >= 500) sample(static_cast<Eigen::Index>(i)) += 0.05;
                if (k >= 500 && j != i) sample(static_cast<Eigen::Index>(j)) -= 0.07;
                const Eigen::VectorXd increment = sample * 0.01;
                const std::array<double, 1> known{input};
                detector->assess({{1, k}, 0.01, {increment.data(), 5}, 0b11111, known}, assessment);
                if (k == 499) {
                    EXPECT_EQ(assessment.outcome, Outcome::healthy);
                }
                state = hold.state * state + hold.input * input;
            }
            EXPECT_EQ(assessment.outcome, Outcome::isolated) << i << " " << j;
            EXPECT_EQ(assessment.isolated, axis_bit(i) | axis_bit(j));
        }
    }
}

TEST(ObserverDetector, says_blind_while_the_rudder_stream_is_stopped_and_starts_again)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
    const std::array<double, 2> increment{0.0001, 0.0002};
    const std::array<double, 1> gone{std::nan("")};
    Assessment assessment;
    detector->assess({{1, 0}, 0.01, increment, 0b11, gone}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::blind);
    detector->assess({{1, 1}, 0.01, increment, 0b11, {}}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::blind);

    std::array<int, 2> seen{};
    std::uint64_t sequence = 0;
    PaperRun run;
    run.gyro_fault = run.accelerometer_fault = 0;
    run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
        const std::array<double, 1> known{time >= 10 && time < 12 ? std::nan("") : rudder};
        const std::array<double, 2> increments{sample(0) * 0.01, sample(1) * 0.01};
        detector->assess({{2, sequence++}, 0.01, increments, 0b11, known}, assessment);
        ++seen[assessment.outcome == Outcome::blind ? 1 : 0];
        EXPECT_EQ(assessment.outcome, time >= 10 && time < 12 ? Outcome::blind : Outcome::healthy) << time;
    });
    EXPECT_EQ(seen[1], 200);
}

TEST(ObserverDetector, bridges_short_gaps_and_missing_samples)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
    std::uint64_t sequence = 0;
    Assessment assessment;
    int assessed = 0;
    PaperRun run;
    run.gyro_fault = run.accelerometer_fault = 0;
    run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
        const std::uint64_t now = sequence++;
        if (now % 50 >= 45) return;
        const bool missing = now % 7 == 3;
        const std::array<double, 1> known{rudder};
        const std::array<double, 2> increments{missing ? 99.0 : sample(0) * 0.01, sample(1) * 0.01};
        detector->assess({{2, now}, 0.01, increments, missing ? 0b10U : 0b11U, known}, assessment);
        ++assessed;
        EXPECT_EQ(assessment.outcome, Outcome::healthy) << time;
    });
    EXPECT_EQ(assessed, 7201);
}

TEST(ObserverDetector, warms_up_where_the_samples_do_not_tell_the_whole_state)
{
    ObserverSettings settings;
    settings.plant = {Eigen::Matrix3d{{-1, 1, 0}, {0, -1, 1}, {0, 0, -1}}, Eigen::Vector3d(0, 0, 1),
                      Eigen::MatrixXd{{1, 0, 0}, {1, 0.5, 0}}};
    settings.poles = {{-2, -2.5, -3}};
    settings.threshold = 1e-2;
    auto detector = ObserverDetector::make(settings, 0.01).value();
    const auto hold = geometry::zero_order_hold(settings.plant.a, settings.plant.b, 0.01);
    Eigen::VectorXd state = Eigen::Vector3d(1, -2, 3);
    Assessment assessment;
    int warming = 0;
    for (std::uint64_t k = 0; k < 1000; ++k) {
        const Eigen::VectorXd increment = settings.plant.c * state * 0.01;
        detector->assess({{1, k}, 0.01, {increment.data(), 2}, 0b11, std::array<double, 1>{0.2}}, assessment);
        warming += assessment.outcome == Outcome::warming_up ? 1 : 0;
        EXPECT_EQ(assessment.outcome, k < 346 ? Outcome::warming_up : Outcome::healthy);
        state = hold.state * state + hold.input * 0.2;
    }
    EXPECT_EQ(warming, 346) << "ln(1000) / 2 s";
}

TEST(VesselMonitor, isolates_latches_and_readmits_the_papers_faults)
{
    const auto play = [](double gyro_fault, double accelerometer_fault) {
        auto monitor = FaultMonitor::make(ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value(), {}, 2).value();
        PaperRun run;
        run.gyro_fault = gyro_fault;
        run.accelerometer_fault = accelerometer_fault;
        std::array<FaultVerdict, 3> at;            // 19 s, 40 s, 75 s
        std::array<AxisMask, 2> contradicted = {};  // 25 s, 40 s
        SensorFrame frame;
        run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
            frame.interval_s = run.interval_s;
            frame.valid_mask = 0b11;
            frame.known_input[0] = rudder;
            for (std::size_t channel : {std::size_t{0}, std::size_t{1}})
                frame.increment[channel] = sample(static_cast<Eigen::Index>(channel)) * run.interval_s;
            const FaultVerdict verdict = monitor.assess(frame);
            if (frame.sequence == 1900) at[0] = verdict;
            if (frame.sequence == 2500) contradicted[0] = monitor.contradicted(0b11);
            if (frame.sequence == 4000) contradicted[1] = monitor.contradicted(0b11);
            if (frame.sequence == 4000) at[1] = verdict;
            if (frame.sequence == 4000) monitor.readmit(0b11);
            if (time < 75.005) at[2] = verdict;
            ++frame.sequence;
        });
        return std::pair{at, contradicted};
    };
    const auto [faulty, contradicted] = play(0.01, 0.01);
    EXPECT_EQ(contradicted[0], 0b10U) << "while its fault lasts";
    EXPECT_EQ(contradicted[1], 0U) << "ten seconds after it";
    EXPECT_EQ(faulty[0].state, octet(VerdictState::healthy));
    EXPECT_EQ(faulty[1].state, octet(VerdictState::isolated)) << "latched, ten seconds after the fault ended";
    EXPECT_EQ(faulty[1].isolated_mask, 0b10U);
    EXPECT_NEAR(static_cast<double>(faulty[1].excluded_from[1]), 2000, 2);
    EXPECT_EQ(faulty[1].detectable_remaining, 1) << "the model stands behind the channel that is left";
    EXPECT_EQ(faulty[2].isolated_mask, 0b01U);
    EXPECT_NEAR(static_cast<double>(faulty[2].excluded_from[0]), 5000, 2);

    for (const FaultVerdict& verdict : play(0, 0).first) EXPECT_EQ(verdict.state, octet(VerdictState::healthy));
}
