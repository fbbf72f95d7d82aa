#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

namespace quorient::sensor {

/// One measurement of an IMU: a body-frame vector (rate, or specific force) at a time of the common clock.
struct ImuSample {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

/// The newest samples of one IMU, and their integral over an interval.
class ImuStream {
public:
    /// @returns false, and keeps nothing, where the stamp is not after the newest one.
    bool add(const ImuSample& sample);

    bool empty() const { return count_ == 0; }
    const ImuSample& newest() const { return samples_[(count_ - 1) % capacity]; }

    /// Forgets everything.
    void clear() { count_ = 0; }

    /// The integral of the value, linear between samples (exact for what changes linearly; error of the trapezoidal rule, value'' h^3 / 12
    /// per pair of samples, else).
    /// @param longest_gap_ns  between two samples that the interval touches. @returns false where samples around the interval are missing.
    bool integrate(std::int64_t begin_ns, std::int64_t end_ns, std::int64_t longest_gap_ns, Eigen::Vector3d& integral) const;

private:
    static constexpr std::size_t capacity = 1024;

    const ImuSample& at(std::size_t index) const { return samples_[index % capacity]; }
    std::size_t oldest() const { return count_ > capacity ? count_ - capacity : 0; }

    std::array<ImuSample, capacity> samples_{};
    std::size_t count_ = 0;
};

}  // namespace quorient::sensor
