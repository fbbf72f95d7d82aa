#pragma once

#include "field/parameters.hpp"

namespace quorient::fdi::field {

/// Which instruments deliver data. One that misses a frame now and then stays in the comparison (that frame says nothing of it); one that is
/// silent for longer, or misses a quarter of its frames, is left out until it has delivered without a gap again. Nobody is blamed for silence.
class Presence {
public:
    explicit Presence(std::size_t instruments) : count_(instruments) {}

    /// @param present  instruments with data in this frame.
    void update(InstrumentSet present);

    InstrumentSet delivering() const { return delivering_; }

    /// Frames since this instrument delivered last, 0 = in the newest one.
    std::uint64_t silent_frames(std::size_t m) const { return silent_[m]; }

    void reset();

private:
    std::size_t count_;
    InstrumentSet delivering_;
    std::array<std::uint32_t, max_members> missing_{};  ///< bit k = no data k frames ago
    std::array<std::uint32_t, max_members> run_{};      ///< frames in a row with data, as far as that matters
    std::array<std::uint64_t, max_members> silent_{};
};

}  // namespace quorient::fdi::field
