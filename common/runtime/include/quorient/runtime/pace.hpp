#pragma once

#include "quorient/messages/identity.hpp"

#include <cstdint>

namespace quorient::runtime {

/// Whether a stream has only the frames that an overloaded service gives out.
class Pace {
public:
    /// An overloaded service gives out the frames whose number this divides. With fewer a lane would be silent for a voter (`silence_intervals`).
    static constexpr unsigned kept_of = 4;

    static bool keeps(Identity identity) { return identity.sequence % kept_of == 0; }

    /// The next newer frame of the stream.
    void see(Identity identity) { kept_in_a_row_ = keeps(identity) ? kept_in_a_row_ + 1 : 0; }

    bool is_shed() const { return kept_in_a_row_ >= certain; }

private:
    /// Frames that are lost by chance are not the same ones so often.
    static constexpr std::uint64_t certain = 5;

    std::uint64_t kept_in_a_row_ = 0;
};

}  // namespace quorient::runtime
