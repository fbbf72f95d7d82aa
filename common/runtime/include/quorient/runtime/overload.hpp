#pragma once

#include <cstdint>

namespace quorient::runtime {

/// How much later samples come than the most punctual ones of the last half to one minute. Their stamps may be of another host's clock: the
/// difference of the clocks and the constant part of the way drop out.
class SampleAge {
public:
    /// @param epoch  of the publisher: another one may have another clock. @param stamp_ns  0 or less = not stamped
    /// @returns 0 for a sample without a stamp.
    std::int64_t see(std::uint64_t epoch, std::int64_t stamp_ns, std::int64_t now_ns);

private:
    /// Long beside any overload that lets no sample through in time, short beside the drift of two clocks.
    static constexpr std::int64_t window_ns = 30'000'000'000;

    std::uint64_t epoch_ = 0;
    bool begun_ = false;              ///< A sample of this epoch has come; the members below mean nothing before.
    std::int64_t window_begin_ns_ = 0;
    std::int64_t least_ns_ = 0;         ///< The least arrival - stamp in this window.
    std::int64_t least_before_ns_ = 0;  ///< In the window before.
};

/// Whether a consumer keeps up with its samples, from their ages. A standstill leaves a queue behind that is worked off without loss. Only
/// samples that stay old are an overload: then results are left out, so that those that are given out are not old.
///
/// It has no clock: times are passed in, as steady nanoseconds.
class Overload {
public:
    enum class State {
        keeping_up,      ///< Left when a sample is old.
        falling_behind,  ///< Samples are old. Left when that has lasted, or when it is made up for.
        shedding,        ///< Results are left out. Left for a trial from time to time, unless samples are old all the same.
        trying,          ///< On trial all results are given out again. Left when the trial has lasted, or when samples become old again.
    };

    explicit Overload(double interval_s);

    /// A sample came that is newer than all before it.
    /// @param stamp_ns  its stamp: trials begin at certain stamps, so that all who share a publisher try together
    State on_sample(std::int64_t age_ns, std::int64_t stamp_ns, std::int64_t now_ns);

    /// The other services shed: this one does, too. Otherwise each one would find that the others leave it room.
    State on_others_shed(std::int64_t now_ns);

    State state() const { return state_; }
    bool sheds() const { return state_ == State::shedding; }

    /// Samples older than this are old: ten intervals, at least 10 ms.
    std::int64_t bound_ns() const { return bound_ns_; }

    /// Old samples for so long, with few punctual ones in between, are an overload.
    static constexpr std::int64_t lasting_ns = 500'000'000;

    /// Trials begin where stamps pass a multiple of this. After each one that failed the next one is `rarer` times as far away.
    static constexpr std::int64_t first_period_ns = 4'000'000'000;
    static constexpr std::int64_t longest_period_ns = 64'000'000'000;
    static constexpr std::int64_t rarer = 4;

    static constexpr std::int64_t trial_ns = 4'000'000'000;

private:
    void measure(bool old, std::int64_t now_ns);
    void enter(State state, std::int64_t now_ns);
    void fail(std::int64_t now_ns);

    std::int64_t bound_ns_;
    bool may_shed_;  ///< At slow rates kept frames would be too far apart.
    State state_ = State::keeping_up;
    bool old_ = false;              ///< The last sample was old.
    std::int64_t last_ns_ = 0;      ///< When it came.
    std::int64_t behind_ns_ = 0;    ///< For so long samples were old, less a part of the time in which they were not.
    std::int64_t last_stamp_ns_ = 0;
    std::int64_t since_ns_ = 0;     ///< When it entered its state.
    std::int64_t period_ns_ = first_period_ns;  ///< The time between trials.
};

}  // namespace quorient::runtime
