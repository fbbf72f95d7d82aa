#pragma once

#include "quorient/fdi/detector.hpp"

#include <array>

namespace quorient::fdi {

/// Readmission for channels that are no directions in space: the method's own model says what an excluded channel should have read
/// (Detector::expectation). One earns its place again when it agreed with the model and the trusted channels for a stated time, *in which
/// as much was expected of it as when its fault showed* (nine tenths: a motion that repeats itself meets its own peak again only up to
/// noise). A stuck or soft sensor of a vessel at rest earns nothing.
///
/// One frame that disagrees starts the time anew; frames that the method cannot judge do not count.
/// What was expected when a fault showed is that of the last frame before which all had been healthy for a second: a fault moves what the
/// directional observers expect, and their metrics may pass 0 before they name it. Never readmits channels whose exclusion was not seen
/// here (adopted after a restart) or came within the first second: nobody knows what exposed them. Allocates nothing.
class ObserverReadmission {
public:
    /// @param healthy_s  time in agreement that is asked for, above 0.
    explicit ObserverReadmission(double healthy_s) : healthy_s_(healthy_s) {}

    /// The detector has assessed one more frame.
    /// @param isolated  after it. @param newly  those that this frame's verdict isolated. @param healthy  the verdict trusts every channel.
    /// @returns the excluded channels that may be trusted again.
    AxisMask watch(const Detector& detector, double interval_s, AxisMask isolated, AxisMask newly, bool healthy);

private:
    struct Trial {
        bool exposed = false;
        double usual = -1;      ///< |value expected| while all was healthy [unit of the measurement]; below 0: not known
        double excitation = 0;  ///< likewise, when the fault showed
        double healthy_s = 0;   ///< in agreement, so far
        double largest = 0;     ///< |value expected| in that time
    };

    double healthy_s_;
    double all_healthy_s_ = 0;  ///< so long now
    std::array<Trial, max_axes> trial_{};
};

}  // namespace quorient::fdi
