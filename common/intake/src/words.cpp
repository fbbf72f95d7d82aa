#include "quorient/intake/frame_intake.hpp"

#include <fmt/format.h>

namespace quorient::intake {

std::string words_for(const FrameIntake::Complaint& complaint)
{
    using Fault = FrameIntake::Fault;
    const auto& [fault, identity, got, expected, why] = complaint;
    switch (fault) {
        case Fault::none:
            break;
        case Fault::description:
            return fmt::format("a description is refused: {}", why);
        case Fault::axis_count:
            return fmt::format("frame {} has {} axes, its description {}", identity.sequence, got, expected);
        case Fault::interval:
            return fmt::format("frame {}: its interval must be 1 ns to an hour", identity.sequence);
        case Fault::sample_time:
            return fmt::format(
                "frame {}: its sample time is not after that of the frame before, or farther than 146 years from its clock's origin",
                identity.sequence);
        case Fault::unknown_revision:
            return fmt::format("frames refer to revision {} of the description; of this epoch, {} is the newest here", got, expected);
        case Fault::no_description:
            return fmt::format("frames of epoch {} come without a description: publish it, latched, with the same epoch", identity.epoch);
        case Fault::sequence_restart:
            return fmt::format("sequence {} after {} in one epoch: a publisher that counts from 0 again must choose a new, larger epoch",
                               got, expected);
        case Fault::value:
            return fmt::format("frame {}: axis {} is not finite, or beyond its stated range", identity.sequence, got);
    }
    return {};
}

}  // namespace quorient::intake
