#pragma once

#include "quorient/messages/limits.hpp"
#include "quorient/recording/instrument_log.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace quorient::recording {

/// Most triads of one frame.
inline constexpr std::size_t max_triads = max_axes / 3;

/// What all instruments measured over one common interval.
struct AlignedFrame {
    std::int64_t time_ns = 0;  ///< end of the interval
    double interval_s = 0;
    std::size_t count = 0;  ///< instruments; axis 3 i + k is axis k of instrument i
    std::array<std::array<double, 3>, max_triads> rate_rad_s{};  ///< mean over the interval
    std::array<std::array<double, 3>, max_triads> acceleration_m_s2{};
    AxisMask valid_mask = 0;         ///< axes whose samples cover the interval
    AxisMask acceleration_mask = 0;
    AxisMask clipped_mask = 0;       ///< axes that the log itself calls clipped in the interval
    bool after_gap = false;          ///< no instrument measured anything between the frame before and this one
};

struct ResampleSettings {
    std::vector<double> period_s;     ///< usual time between two samples of each instrument
    std::size_t leader = 0;           ///< whose sample times are the frames' ends
    std::size_t samples_per_frame = 1;  ///< samples of the leader in one frame
    double patience_s = 5.0;          ///< frames do not wait for an instrument that is farther behind
};

/// Puts the samples of several instruments, each with times of its own, on common intervals: a rate holds from the sample before to its own
/// sample (or over what the log says that it covers), and each interval gets the mean of the rates that hold in it. So no rotation is lost or
/// counted twice, and an instrument that misses samples loses the intervals that they cover, not its pairing with the others.
/// Where all samples of an interval agree on a value, the frame has exactly this value.
class Resampler {
public:
    explicit Resampler(ResampleSettings settings);

    /// @param time_ns  the sample's place on the common clock. Samples that do not come after the instrument's one before are counted and
    ///                 left out.
    void add(std::size_t instrument, std::int64_t time_ns, const InstrumentSample& sample);

    /// No more samples: the frames that are left end with the newest one.
    void finish();

    /// The next frame, if all that belongs in it is there.
    bool next(AlignedFrame& frame);

    /// Samples left out since their time was not after that of the one before.
    std::uint64_t out_of_order() const { return out_of_order_; }

private:
    /// A time during which an instrument's rate holds.
    struct Span {
        std::int64_t begin_ns = 0;
        std::int64_t end_ns = 0;
        std::array<double, 3> rate_rad_s{};
        std::array<double, 3> acceleration_m_s2{};
        std::uint8_t clipped = 0;
    };

    struct Track {
        std::deque<Span> spans;
        std::int64_t last_ns = 0;
        bool begun = false;
    };

    void lead(std::int64_t time_ns);
    void lead_without_leader();
    void push_ends(std::int64_t up_to_ns, double interval_s);
    bool waits_for(const Track& track, std::int64_t end_ns) const;
    void fill(AlignedFrame& frame, std::size_t instrument, std::int64_t begin_ns) const;

    ResampleSettings settings_;
    std::vector<Track> tracks_;
    double interval_s_;
    std::optional<std::int64_t> first_ns_;   // where the first sample's span begins
    std::deque<std::int64_t> ends_ns_;       // where the next frames end
    std::optional<std::int64_t> last_end_ns_;  // the newest of them, given out or not
    std::optional<std::int64_t> begin_ns_;   // where the next frame begins
    std::int64_t newest_ns_ = 0;
    std::uint64_t out_of_order_ = 0;
    bool gap_ = true;
    bool finished_ = false;
};

}  // namespace quorient::recording
