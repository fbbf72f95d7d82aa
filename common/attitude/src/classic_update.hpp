#pragma once

#include "quorient/attitude/update.hpp"

namespace quorient::attitude {

/// The classical rotation-vector formulas (docs/methods/coning.md, "Classical rules"). N samples make one rotation vector:
///   N = 1          phi = th
///   1 + previous   phi = th + 1/12 th_previous x th
///   N = 2          phi = th1 + th2 + 2/3 th1 x th2
///   N = 3          phi = sum + (9/20 th1 + 27/20 th2) x th3
///   N = 3, Miller  phi = sum + 9/20 th1 x th3 + 27/40 th2 x (th3 - th1)
///   N = 4          phi = sum + (54/105 th1 + 92/105 th2 + 214/105 th3) x th4
/// All but `previous` assume equal intervals. Between full updates the best formula for the samples already there is used.
enum class ClassicRule { single, previous, two_sample, three_sample, three_sample_miller, four_sample };

class ClassicUpdate : public Update {
public:
    explicit ClassicUpdate(ClassicRule rule) : rule_(rule) {}

    std::size_t memory() const override;
    Step step(std::uint64_t count, std::span<const Sample> recent) const override;

private:
    std::size_t block() const;

    ClassicRule rule_;
};

/// The rotation vector of the whole block: 1 to 4 samples.
Eigen::Vector3d rotation_vector(std::span<const Sample> block, ClassicRule rule);

}  // namespace quorient::attitude
