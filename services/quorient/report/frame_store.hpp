#pragma once

#include "quorient/recording/resampler.hpp"
#include "temporary_file.hpp"

#include <functional>
#include <vector>

namespace quorient::cli {

/// Frames that are read again and again: the first 32 MB in memory, the rest in a temporary file that goes with the process.
/// Rates are kept with the precision of a float.
class FrameStore {
public:
    /// @param instruments  of each frame
    explicit FrameStore(std::size_t instruments) : instruments_(instruments) {}

    /// @returns false where the disk takes no more: the store is of no use from then on.
    bool add(const recording::AlignedFrame& frame);

    /// After the last frame. @returns false where the disk has not taken them all.
    bool flush();

    /// All frames, in order. @returns false where the file cannot be read back.
    bool each(const std::function<void(const recording::AlignedFrame&)>& visit);

private:
    /// A frame in few bytes. Its rates stand behind it.
    struct Kept {
        std::int64_t time_ns;
        float interval_s;
        AxisMask valid_mask;
        AxisMask clipped_mask;
        std::uint32_t after_gap;
    };

    std::size_t record_size() const { return sizeof(Kept) + 3 * instruments_ * sizeof(float); }
    void unpack(const unsigned char* record, recording::AlignedFrame& frame) const;

    std::size_t instruments_;
    std::vector<unsigned char> memory_;
    std::vector<unsigned char> record_;  ///< the one in hand
    TemporaryFile file_;
    std::uint64_t in_file_ = 0;  ///< frames
};

}  // namespace quorient::cli
