#pragma once

#include "field/parameters.hpp"

#include <optional>
#include <vector>

namespace quorient::fdi::field {

/// Finds noise and intermittent faults, which no window's sum shows: an instrument that is off in more than a third of the last second's
/// frames, and more than twice as often as any other one.
class Erratic {
public:
    Erratic(std::size_t instruments, double interval_s);

    void reset();

    /// @param off  of each component: the instruments whose deviation in this frame no noise explains
    void add(const std::array<InstrumentSet, component_count>& off);

    struct Finding {
        std::size_t instrument;
        std::size_t component;
        double share;  ///< as a part of the frames
    };
    std::optional<Finding> finding(InstrumentSet compared) const;

    /// Share of the last second's frames that this instrument was off in.
    double share(std::size_t component, std::size_t m) const;

private:
    std::size_t count_;
    std::vector<std::array<InstrumentSet, component_count>> frames_;  ///< ring
    std::size_t next_ = 0;
    std::array<std::array<std::size_t, max_members>, component_count> off_{};
};

}  // namespace quorient::fdi::field
