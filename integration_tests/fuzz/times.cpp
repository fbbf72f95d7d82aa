#include "bytes.hpp"
#include "quorient/recording/instrument_clock.hpp"
#include "quorient/recording/resampler.hpp"
#include "quorient/recording/timing.hpp"
#include "require.hpp"
#include "targets.hpp"
#include "time/stamp_guard.hpp"

#include <cmath>
#include <deque>

namespace quorient::fuzz {

namespace {

using recording::AlignedFrame;
using recording::InstrumentSample;

constexpr double largest_rate_rad_s = 128;
constexpr double period_unit_s = 0.005;

/// One instrument: its clock, and what its samples pass before they are put on the common intervals.
struct Source {
    Source(double usual_s, bool placed_on_own_clock) : period_s(usual_s), guard(usual_s), clock(usual_s), own_clock(placed_on_own_clock) {}

    double period_s;
    recording::StampGuard guard;
    recording::ArrivalClock clock;
    recording::PeriodEstimator estimator{period_s};
    recording::InstrumentMeter meter;
    bool own_clock;
    std::int64_t time_ns = 1'000'000'000'000;
    std::deque<InstrumentSample> waiting;
};

/// The next stamp: near the usual one, repeated, a little back, or anywhere.
std::int64_t step_ns(std::uint8_t code, std::uint8_t more, double period_s)
{
    const double usual_ns = period_s * 1e9;
    if (code < 200) return std::llround(usual_ns * (0.8 + 0.4 * more / 255.0));
    if (code < 210) return 0;
    if (code < 220) return -std::llround(usual_ns * more / 8.0);
    if (code < 240) return std::llround(usual_ns * more / 8.0);
    const std::int64_t far_ns = std::int64_t{more} * 400'000'000;
    return code < 248 ? far_ns : -far_ns * 1000;
}

InstrumentSample sample_of(Bytes& bytes, Source& source)
{
    InstrumentSample sample;
    const std::uint8_t code = bytes.byte();
    source.time_ns += step_ns(code, bytes.byte(), source.period_s);
    sample.time_ns = source.time_ns;
    for (double& rate : sample.rate_rad_s) {
        const auto value = static_cast<std::int8_t>(bytes.byte());
        rate = value == -128 ? std::nan("") : value;
    }
    if (code % 8 == 7) sample.covered_s = source.period_s * bytes.byte() / 128.0;
    if (code % 8 == 6) sample.clipped = bytes.byte();
    return sample;
}

/// Frames follow one another without overlap, and no mean leaves the range of what it is the mean of.
class Check {
public:
    void take(recording::Resampler& resampler)
    {
        AlignedFrame frame;
        while (resampler.next(frame)) {
            REQUIRE(std::isfinite(frame.interval_s) && frame.interval_s > 0);
            REQUIRE(!last_ns_ || frame.time_ns > *last_ns_);
            const double begin_ns = static_cast<double>(frame.time_ns) - frame.interval_s * 1e9;
            REQUIRE(!last_ns_ || begin_ns > static_cast<double>(*last_ns_) - 1000);
            REQUIRE(frame.after_gap || (last_ns_ && std::abs(begin_ns - static_cast<double>(*last_ns_)) < 1000));
            REQUIRE(frame.valid_mask != 0 && frame.valid_mask >> 3 * frame.count == 0);
            for (std::size_t axis = 0; axis < 3 * frame.count; ++axis) {
                const double rate = frame.rate_rad_s[axis / 3][axis % 3];
                REQUIRE(std::abs(rate) <= largest_rate_rad_s * (1 + 1e-9));
                REQUIRE(has_axis(frame.valid_mask, axis) || rate == 0);
            }
            last_ns_ = frame.time_ns;
        }
    }

private:
    std::optional<std::int64_t> last_ns_;
};

void place(Source& source, const std::vector<InstrumentSample>& good, std::size_t number, recording::Resampler& resampler)
{
    for (const InstrumentSample& sample : good) {
        if (!source.own_clock) resampler.add(number, sample.time_ns, sample);
        else {
            source.clock.add(sample.time_ns);
            source.waiting.push_back(sample);
        }
    }
    while (const auto placed = source.clock.next()) {
        REQUIRE(!source.waiting.empty() && std::isfinite(placed->late_s));
        resampler.add(number, placed->time_ns, source.waiting.front());
        source.waiting.pop_front();
    }
}

void check_figures(const Source& source)
{
    const auto figures = source.meter.figures();
    REQUIRE(figures.period_s >= 0 && std::isfinite(figures.jitter_s));
    REQUIRE(figures.coverage >= 0 && figures.coverage <= 1);
    const auto period_s = source.estimator.period_s();
    REQUIRE(!period_s || std::isfinite(*period_s));
}

}  // namespace

void times(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes(data, size);
    recording::ResampleSettings settings;
    std::vector<Source> sources;
    const std::size_t count = 1 + bytes.byte() % 4;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t code = bytes.byte();
        sources.emplace_back(period_unit_s * (1 + code % 16), code >= 128);
        settings.period_s.push_back(sources.back().period_s);
    }
    settings.leader = bytes.byte() % count;
    settings.samples_per_frame = 1 + bytes.byte() % 3;
    recording::Resampler resampler(settings);
    Check check;
    std::vector<InstrumentSample> good;
    while (!bytes.empty()) {
        const std::size_t number = bytes.byte() % count;
        Source& source = sources[number];
        const InstrumentSample sample = sample_of(bytes, source);
        source.meter.add(sample);
        source.estimator.add(sample.time_ns);
        good.clear();
        source.guard.add(sample, good);
        place(source, good, number, resampler);
        check.take(resampler);
    }
    for (std::size_t i = 0; i < count; ++i) {
        good.clear();
        sources[i].guard.finish(good);
        sources[i].clock.finish();
        place(sources[i], good, i, resampler);
        REQUIRE(sources[i].waiting.empty());
        check_figures(sources[i]);
    }
    resampler.finish();
    check.take(resampler);
}

}  // namespace quorient::fuzz
