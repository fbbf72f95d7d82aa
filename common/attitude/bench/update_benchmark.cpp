// What one sample costs, beside the least it can cost: ./attitude_benchmark
#include "../test/scenario.hpp"

#include <benchmark/benchmark.h>
#include <array>

namespace {

using namespace quorient;
using namespace quorient::attitude;
using namespace quorient::attitude::testing;

constexpr double interval_s = 0.01;
constexpr std::size_t rows = 1000;

std::vector<Sample> samples(const ClassicConing& motion)
{
    std::vector<Sample> list;
    for (std::size_t row = 0; row < rows; ++row)
        list.push_back({motion.increment(static_cast<Wide>(row) * interval_s, interval_s), interval_s});
    return list;
}

// One sine, one cosine, one quaternion product.
void floor_of_all(benchmark::State& state)
{
    const auto list = samples(ClassicConing(10, 1));
    Quaternion q = Quaternion::Identity();
    std::size_t row = 0;
    for (auto _ : state) {
        const Eigen::Vector3d& th = list[row++ % rows].increment;
        const double angle = th.norm();
        const double scale = std::sin(angle / 2) / angle;
        q = q * Quaternion(std::cos(angle / 2), scale * th.x(), scale * th.y(), scale * th.z());
        benchmark::DoNotOptimize(q);
    }
}
BENCHMARK(floor_of_all);

void per_sample(benchmark::State& state, const std::string& algorithm, const ClassicConing& motion)
{
    const auto list = samples(motion);
    Propagator stream(make_update(algorithm).value(), motion.attitude(0));
    std::size_t row = 0;
    for (auto _ : state) {
        Quaternion q = stream.add(list[row++ % rows]);
        benchmark::DoNotOptimize(q);
    }
}

// A frame of six axes through the integrator: least squares, history, window, trust.
void integrator_frame(benchmark::State& state)
{
    const auto cluster = cluster_of("cone-6", interval_s, 1e-6);
    const ClassicConing motion(10, 1);
    Instrument instrument(cluster, motion);
    auto frames = record(instrument, rows);
    Integrator integrator = Integrator::make(settings_for(motion, 10), cluster).value();
    std::uint64_t sequence = 0;
    for (auto _ : state) {
        SensorFrame& frame = frames[sequence % rows];
        frame.sequence = sequence;
        integrator.apply(verdict_on(sequence++));
        integrator.add(frame);
        benchmark::DoNotOptimize(integrator.publish());
    }
}
BENCHMARK(integrator_frame);

// Every verdict revises the onset of axis 2 by a few frames, 1000 frames back: what follows is integrated again each time.
void rollback_of_1000_frames(benchmark::State& state)
{
    const auto cluster = cluster_of("cone-6", interval_s, 1e-6);
    const ClassicConing motion(10, 1);
    auto frames = record(Instrument(cluster, motion), rows);
    Integrator integrator = Integrator::make(settings_for(motion, 11), cluster).value();
    std::uint64_t sequence = 0;
    const auto add = [&] {
        SensorFrame& frame = frames[sequence % rows];
        frame.sequence = sequence++;
        integrator.add(frame);
    };
    while (sequence < 2000) add();
    std::uint64_t integrated_again = 0;
    for (auto _ : state) {
        add();
        integrator.publish();
        integrator.apply(isolating(sequence - 1, 2, sequence - 1000 + (sequence % 2 == 0 ? 5 : 0)));
        finish(integrator);
        integrated_again += integrator.state().rolled_back_frames;
    }
    state.counters["frames"] = benchmark::Counter(static_cast<double>(integrated_again), benchmark::Counter::kAvgIterations);
}
BENCHMARK(rollback_of_1000_frames)->Unit(benchmark::kMicrosecond);

void register_updates()
{
    for (const char* name : {"single", "previous", "two-sample", "three-sample", "three-sample-miller", "four-sample", "block-8",
                             "window-4", "window-8", "window-10", "window-12"})
        benchmark::RegisterBenchmark(name, [name](benchmark::State& state) { per_sample(state, name, ClassicConing(10, 1)); });
    benchmark::RegisterBenchmark("window-10, 0.31 rad per sample",
                                 [](benchmark::State& state) { per_sample(state, "window-10", ClassicConing(60, 5)); });
}

}  // namespace

int main(int argc, char** argv)
{
    benchmark::Initialize(&argc, argv);
    register_updates();
    benchmark::RunSpecifiedBenchmarks();
}
