// Nanoseconds per assessment of every method on 4, 6, 8 and 24 axes, beside the product z -> V z that none can do without.

#include "quorient/fdi/methods.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/geometry/parity_space.hpp"

#include <benchmark/benchmark.h>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace quorient;

constexpr std::size_t frame_count = 256;
constexpr double interval_s = 0.01;
constexpr double noise_rad = 1e-5;  // one frame's increment has it

geometry::SensorCluster cluster_of(const std::string& layout)
{
    auto cluster = geometry::layout(layout).value();
    cluster.interval_s = interval_s;
    return cluster;
}

/// Slow motion of 1 rad/s with noise, within every gyro's range; a fault of 200 sigma (0.2 rad/s) on axis 1 where `faulty`.
std::vector<std::vector<double>> frames_of(const geometry::SensorCluster& cluster, bool faulty)
{
    std::mt19937_64 engine(5);
    std::normal_distribution<double> normal;
    std::vector<std::vector<double>> frames;
    for (std::size_t k = 0; k < frame_count; ++k) {
        const double phase = 0.01 * static_cast<double>(k);
        const geometry::AxisVector clean = cluster.axes * (1000 * noise_rad * Eigen::Vector3d(std::cos(phase), std::sin(phase), 0.3));
        std::vector<double> z(clean.data(), clean.data() + clean.size());
        for (double& value : z) value += noise_rad * normal(engine);
        if (faulty && k > frame_count / 8) z[1] += 200 * noise_rad;
        frames.push_back(std::move(z));
    }
    return frames;
}

void product(benchmark::State& state, const std::string& layout)
{
    const auto cluster = cluster_of(layout);
    const Eigen::MatrixXd basis = geometry::ParitySpace(cluster.axes).basis();
    const auto frames = frames_of(cluster, false);
    Eigen::VectorXd parity(basis.rows());
    std::size_t next = 0;
    for (auto _ : state) {
        const auto& z = frames[next++ % frame_count];
        parity.noalias() = basis * Eigen::Map<const Eigen::VectorXd>(z.data(), basis.cols());
        benchmark::DoNotOptimize(parity.data());
    }
}

void assessment(benchmark::State& state, const fdi::DetectorSettings& settings, const std::string& layout, bool faulty)
{
    const auto cluster = cluster_of(layout);
    const auto detector = fdi::make_detector(settings, cluster).value();
    const auto frames = frames_of(cluster, faulty);
    fdi::Assessment assessment;
    std::uint64_t sequence = 0;
    for (auto _ : state) {
        detector->assess(
            {.identity = {1, sequence}, .interval_s = interval_s, .increment = frames[sequence % frame_count], .valid = cluster.all()},
            assessment);
        ++sequence;
        benchmark::DoNotOptimize(assessment);
    }
}

void add_methods(const std::string& axes, const std::string& layout)
{
    const auto cluster = cluster_of(layout);
    benchmark::RegisterBenchmark(("product/" + axes).c_str(), product, layout);
    for (const auto& entry : fdi::methods()) {
        fdi::DetectorSettings settings;
        settings.method = entry.word;
        settings.sigma = noise_rad;
        settings.bound = 4 * noise_rad;
        if (settings.method == "auto" || !fdi::make_detector(settings, cluster)) continue;
        for (const bool faulty : {false, true})
            benchmark::RegisterBenchmark((settings.method + "/" + axes + (faulty ? "/fault" : "/healthy")).c_str(), assessment, settings,
                                         layout, faulty);
    }
}

}  // namespace

int main(int argc, char** argv)
{
    add_methods("4", "cone-4");
    add_methods("6", "dodecahedron");
    add_methods("8", "octahedron-8");
    add_methods("9", "triads-3");
    add_methods("24", "triads-8");
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
