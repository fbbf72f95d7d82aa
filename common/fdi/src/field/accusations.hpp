#pragma once

#include "field/parameters.hpp"
#include "quorient/fdi/detector.hpp"

#include <cmath>

namespace quorient::fdi::field {

/// What is held against each member of a comparison (instruments, or single axes): left out for a while, or named until it is excluded. Times
/// are counts of compared frames.
class Accusations {
public:
    /// An accused one returns, and learning goes on, so long after the last contradiction.
    static constexpr double calm_s = 0.5;

    /// @param least_in_use  members that are never left out together
    Accusations(std::size_t members, std::size_t least_in_use, double interval_s)
        : members_(members),
          least_in_use_(least_in_use),
          calm_frames_(frames_in(calm_s, interval_s)),
          whipsaw_frames_(frames_in(whipsaw_s, interval_s))
    {
    }

    void reset();
    void acquit(std::size_t m) { of_[m] = {}; }

    bool named(std::size_t m) const { return of_[m].named; }
    bool left_out(std::size_t m, std::uint64_t now) const { return of_[m].named || (now > 0 && now <= of_[m].left_out_until); }
    std::uint64_t onset(std::size_t m) const { return of_[m].onset; }

    /// Nobody has been contradicted for a while.
    bool calm(std::uint64_t now) const { return now >= calm_from_; }

    /// Since when a member is left out, or else this one.
    std::uint64_t onset_or(std::size_t m, std::uint64_t begin, std::uint64_t now) const
    {
        return left_out(m, now) && of_[m].onset != never ? of_[m].onset : begin;
    }

    /// For so many frames and the time after them. The others that are left out return, the first ones first, while too few are in use.
    /// @returns whether this one comes and goes too often.
    bool leave_out(std::size_t m, std::uint64_t onset, std::uint64_t frames, std::uint64_t now, InstrumentSet compared);

    /// @param certainty  the largest of the frame in which it is named; reported until the member is excluded
    void name(std::size_t m, std::uint64_t onset, double certainty)
    {
        of_[m].named = true;
        of_[m].onset = onset;
        of_[m].certainty = certainty;
    }

    /// What is held against this member: a named one is isolated; it, and one of the comparison that is left out, is left out of the attitude.
    /// @param axes  the member's
    void report(std::size_t m, AxisMask axes, std::uint64_t now, InstrumentSet compared, Assessment& assessment) const;

    /// Where all members have been reported and nobody is isolated, those that are left out are suspect.
    static void report_suspects(Assessment& assessment);

private:
    /// A member that is left out more than `most_returns` times within this time is erratic.
    static constexpr double whipsaw_s = 10;
    static constexpr std::size_t most_returns = 6;

    struct Accusation {
        bool named = false;                 ///< until it is excluded
        std::uint64_t left_out_until = 0;
        std::uint64_t onset = never;        ///< sequence, of the present contradiction or of the named fault
        double certainty = 0;               ///< the named fault's
        std::array<std::uint64_t, most_returns> begun{};  ///< when the latest contradictions began, ring
        std::size_t contradictions = 0;
    };

    static std::uint64_t frames_in(double seconds, double interval_s) { return static_cast<std::uint64_t>(std::lround(seconds / interval_s)); }
    bool comes_and_goes(Accusation& accused, std::uint64_t now) const;
    void keep_in_use(std::size_t accused, std::uint64_t now, InstrumentSet compared);

    std::size_t members_;
    std::size_t least_in_use_;
    std::uint64_t calm_frames_;
    std::uint64_t whipsaw_frames_;
    std::uint64_t calm_from_ = 0;
    std::array<Accusation, max_members> of_{};
};

}  // namespace quorient::fdi::field
