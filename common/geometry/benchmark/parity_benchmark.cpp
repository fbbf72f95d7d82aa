#include "quorient/geometry/layouts.hpp"
#include "quorient/geometry/parity_space.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <benchmark/benchmark.h>

namespace quorient::geometry {
namespace {

Axes cone_of(std::int64_t count)
{
    return layout("cone-" + std::to_string(count)).value().axes;
}

/// The floor of every method: one Eigen product of the same size, nothing else.
void eigen_product(benchmark::State& state)
{
    const AxisMatrix v = ParitySpace(cone_of(state.range(0))).basis();
    AxisVector z = AxisVector::LinSpaced(v.cols(), -1, 1), p(v.rows());
    for (auto _ : state) {
        benchmark::DoNotOptimize(z.data());
        p.noalias() = v * z;
        benchmark::DoNotOptimize(p.data());
    }
}

void parity_vector(benchmark::State& state)
{
    const ParitySpace space(cone_of(state.range(0)));
    AxisVector z = AxisVector::LinSpaced(space.size(), -1, 1);
    for (auto _ : state) {
        benchmark::DoNotOptimize(z.data());
        benchmark::DoNotOptimize(space.vector(z));
    }
}

void residual(benchmark::State& state)
{
    const ParitySpace space(cone_of(state.range(0)));
    AxisVector z = AxisVector::LinSpaced(space.size(), -1, 1);
    for (auto _ : state) {
        benchmark::DoNotOptimize(z.data());
        benchmark::DoNotOptimize(space.residual(z));
    }
}

void rebuild_without_an_axis(benchmark::State& state)
{
    const Axes axes = cone_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(ParitySpace(axes, ~AxisMask{2}));
}

void rank_rule(benchmark::State& state)
{
    const Axes axes = cone_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(detectable_with(axes));
}

BENCHMARK(eigen_product)->Arg(4)->Arg(6)->Arg(8)->Arg(24);
BENCHMARK(parity_vector)->Arg(4)->Arg(6)->Arg(8)->Arg(24);
BENCHMARK(residual)->Arg(4)->Arg(6)->Arg(8)->Arg(24);
BENCHMARK(rebuild_without_an_axis)->Arg(4)->Arg(6)->Arg(8)->Arg(24);
BENCHMARK(rank_rule)->Arg(4)->Arg(6)->Arg(8)->Arg(24);

}  // namespace
}  // namespace quorient::geometry

BENCHMARK_MAIN();
