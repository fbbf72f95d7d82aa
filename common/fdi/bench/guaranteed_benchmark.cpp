// The guaranteed assessment of six axes: the closed form beside the 180 linear programs that it replaces, on the same frames.
// Before it measures, it checks that both give the same answers; exits 1 where they do not.

#include "guaranteed_comparison.hpp"
#include "guaranteed_frames.hpp"
#include "quorient/geometry/layouts.hpp"

#include <benchmark/benchmark.h>
#include <cstdio>
#include <map>
#include <string>

namespace {

using namespace quorient;
using fdi::GuaranteedDetector;
using fdi::GuaranteedPrograms;

constexpr std::size_t compared_frames = 20'000;
constexpr std::size_t timed_frames = 1024;

struct Setup {
    geometry::SensorCluster cluster;
    std::unique_ptr<GuaranteedDetector> detector;
    GuaranteedPrograms programs;
    std::vector<std::vector<double>> frames;

    explicit Setup(const std::string& layout)
        : cluster(geometry::layout(layout).value()), programs(cluster.axes, 1), frames(fdi::guaranteed_frames(cluster, timed_frames, 7))
    {
        fdi::DetectorSettings settings;
        settings.bound = 1;
        settings.threshold = 10;
        detector = GuaranteedDetector::make(settings, cluster).value();
    }
};

void closed_form(benchmark::State& state, const std::string& layout)
{
    const Setup setup(layout);
    fdi::Assessment assessment;
    std::size_t next = 0;
    for (auto _ : state) {
        const auto& z = setup.frames[next++ % timed_frames];
        setup.detector->assess({.identity = {}, .increment = z, .valid = setup.cluster.all()}, assessment);
        benchmark::DoNotOptimize(assessment);
    }
}

void linear_programs(benchmark::State& state, const std::string& layout, GuaranteedPrograms::Start start)
{
    Setup setup(layout);
    std::size_t next = 0;
    for (auto _ : state) benchmark::DoNotOptimize(setup.programs.solve(setup.frames[next++ % timed_frames], start));
}

/// Remembers the times, to print their ratios at the end.
class Reporter : public benchmark::ConsoleReporter {
public:
    void ReportRuns(const std::vector<Run>& runs) override
    {
        ConsoleReporter::ReportRuns(runs);
        for (const Run& run : runs) time_s[run.benchmark_name()] = run.cpu_accumulated_time / static_cast<double>(run.iterations);
    }

    std::map<std::string, double> time_s;
};

bool same_answers(const std::string& layout)
{
    Setup setup(layout);
    const auto result =
        fdi::compare(*setup.detector, setup.programs, setup.cluster.axes, 1, fdi::guaranteed_frames(setup.cluster, compared_frames, 3));
    std::printf(
        "%s: %zu frames (%zu empty, %zu within 1e-5 sigma of a boundary not compared): emptiness differs in %zu, largest difference %.1e "
        "sigma\n",
        layout.c_str(), result.frames, result.empty, result.at_the_boundary, result.emptiness_differs, result.largest_difference);
    return result.emptiness_differs == 0 && result.largest_difference < 1e-6;
}

}  // namespace

int main(int argc, char** argv)
{
    const std::vector<std::string> layouts{"guaranteed-cone", "dodecahedron"};
    for (const auto& layout : layouts) {
        if (!same_answers(layout)) return 1;
        benchmark::RegisterBenchmark((layout + "/closed_form").c_str(), closed_form, layout);
        benchmark::RegisterBenchmark((layout + "/180_programs").c_str(), linear_programs, layout,
                                     GuaranteedPrograms::Start::standard_basis);
        benchmark::RegisterBenchmark((layout + "/180_programs_warm").c_str(), linear_programs, layout,
                                     GuaranteedPrograms::Start::last_basis);
    }
    benchmark::Initialize(&argc, argv);
    Reporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    for (const auto& layout : layouts)
        std::printf("%s: the closed form is %.0f times as fast as 180 programs, %.0f times as fast where each starts from the last basis\n",
                    layout.c_str(), reporter.time_s[layout + "/180_programs"] / reporter.time_s[layout + "/closed_form"],
                    reporter.time_s[layout + "/180_programs_warm"] / reporter.time_s[layout + "/closed_form"]);
}
