#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace quorient::fdi {

/// Frames for the guaranteed method with noise inside the bound 1: none, one, two or three faulty axes in turn (three are often
/// beyond every explanation), motion up to hundreds of sigma.
inline std::vector<std::vector<double>> guaranteed_frames(const geometry::SensorCluster& cluster, std::size_t count, std::uint64_t seed)
{
    std::mt19937_64 engine(seed);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); };
    std::vector<std::size_t> axis(cluster.size());
    std::iota(axis.begin(), axis.end(), std::size_t{0});
    std::vector<std::vector<double>> frames;
    for (std::size_t k = 0; k < count; ++k) {
        const Eigen::Vector3d body(uniform(-300, 300), uniform(-300, 300), uniform(-300, 300));
        const geometry::AxisVector clean = cluster.axes * body;
        std::vector<double> z(clean.data(), clean.data() + clean.size());
        for (double& value : z) value += uniform(-1, 1);
        std::shuffle(axis.begin(), axis.end(), engine);
        for (std::size_t fault = 0; fault < k % 4; ++fault) z[axis[fault]] += (engine() % 2 == 0 ? 1 : -1) * std::exp(uniform(1, 6));
        frames.push_back(std::move(z));
    }
    return frames;
}

}  // namespace quorient::fdi
