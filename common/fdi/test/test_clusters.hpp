#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/layouts.hpp"

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace quorient::fdi {

inline geometry::SensorCluster cluster_named(const std::string& name)
{
    return geometry::layout(name).value();
}

inline Assessment assess(Detector& detector, const std::vector<double>& z)
{
    Assessment assessment;
    detector.assess({.identity = {}, .increment = z, .valid = all_axes(z.size())}, assessment);
    return assessment;
}

/// What the axes measure of a body vector, without error.
inline std::vector<double> measure(const geometry::SensorCluster& cluster, const Eigen::Vector3d& body)
{
    const geometry::AxisVector z = cluster.axes * body;
    return {z.data(), z.data() + z.size()};
}

using Fault = std::pair<std::size_t, double>;

inline std::vector<double> measure(const geometry::SensorCluster& cluster, const Eigen::Vector3d& body, const std::vector<Fault>& faults)
{
    auto z = measure(cluster, body);
    for (const auto& [axis, size] : faults) z[axis] += size;
    return z;
}

/// Seeded randomness; print seed() where a test fails.
class Random {
public:
    explicit Random(std::uint64_t seed) : seed_(seed), engine_(seed) {}

    std::uint64_t seed() const { return seed_; }
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    double normal() { return normal_(engine_); }
    double sign() { return engine_() % 2 == 0 ? 1 : -1; }
    std::size_t below(std::size_t count) { return engine_() % count; }
    Eigen::Vector3d body(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

    /// `count` different axes.
    AxisMask axes(std::size_t count, std::size_t of)
    {
        AxisMask mask = 0;
        while (static_cast<std::size_t>(std::popcount(mask)) < count) mask |= axis_bit(below(of));
        return mask;
    }

private:
    std::uint64_t seed_;
    std::mt19937_64 engine_;
    std::normal_distribution<double> normal_;
};

}  // namespace quorient::fdi
