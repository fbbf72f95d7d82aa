#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/observer_bank.hpp"
#include "quorient/messages/stream_place.hpp"

#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// Bounds of `margin`, below.
inline constexpr settings::Bounds observer_margin_bounds{.lowest = 1};

/// Fault detection by observers, behind the interface of all methods. Channels are the axes; a channel's sample is its increment divided by
/// the interval, the known inputs are those of the frame.
///
/// Directional: the channel with the largest metric above its limit, once metrics have been above their limits for the bank's
/// attribution time; before that a fault is seen and not attributed. Where another metric is above its limit too and within `margin` of the
/// largest, both channels are candidates. A fault shorter than the attribution time may be laid at the wrong channel's door.
/// Blind: channel i is a candidate if all that the observer without i expects of the other channels comes true. All are: healthy. Exactly
/// one is: isolated. Several: ambiguous. None: a pair, where an observer without it explains the rest; else blind.
///
/// For the settling time after a start it names nobody: samples that were already faulty then are the observers' first state, and until
/// that has decayed the blind scheme would lay the fault at another channel's door.
///
/// An input that is not finite (a rudder stream that stopped) makes the verdict `blind`: without it nothing can be expected. When it comes
/// back, and after a gap of more than 20 frames, the observers start again; they warm up where the channels that are trusted and valid do
/// not determine the whole state.
///
/// An excluded channel would be a healthy one again (expectation) where nothing that the observers see contradicts the trusted channels and
/// it. Directional: all metrics are below their limits; the value expected is then the observer's own, which the fault moves as long as it
/// lasts. Blind: the value expected comes from the other channels alone, where two or more are trusted or the channel left is.
class ObserverDetector final : public Detector {
public:
    static tl::expected<std::unique_ptr<ObserverDetector>, std::string> make(const ObserverSettings& settings, double interval_s,
                                                                             double margin = 1.0);

    void assess(const Measurement& measurement, Assessment& assessment) override;
    void exclude(AxisMask excluded) override { excluded_ = excluded; }
    unsigned detectable_remaining() const override;
    std::optional<Expectation> expectation(std::size_t channel) const override;
    std::string_view reason() const override;
    void reset() override { place_.reset(); }

    const ObserverBank& bank() const { return bank_; }

private:
    ObserverDetector(ObserverBank bank, double interval_s, double margin) : bank_(std::move(bank)), interval_s_(interval_s), margin_(margin)
    {
    }

    bool read_input(const Measurement& measurement);
    void follow_to(const Measurement& measurement);
    void judge_directional(std::uint64_t sequence, Assessment& assessment);
    void judge_blind(Assessment& assessment) const;
    static void withhold_names(Assessment& assessment);
    void judge_last(AxisMask working, Assessment& assessment) const;
    bool settled() const { return place_ && frames_ > settling_frames_; }
    bool agrees_with(AxisMask trusted, AxisMask excluded) const;
    double worst(std::size_t observer, AxisMask channels) const;
    void report(std::size_t observer, double interval_s, Assessment& assessment) const;
    AxisMask working() const { return all_axes(bank_.channels()) & ~excluded_; }

    ObserverBank bank_;
    double interval_s_;
    double margin_;
    AxisMask excluded_ = 0;
    std::optional<StreamPlace> place_;
    AxisMask valid_ = 0;                 ///< the newest frame's
    std::uint64_t frames_ = 0;           ///< since the observers started
    std::uint64_t settling_frames_ = 0;  ///< those among them that show nothing yet
    std::uint64_t naming_frames_ = 0;    ///< those among them in which no fault is named yet (blind)
    std::uint64_t alarm_since_ = 0;      ///< directional: the sequence with which alarm_frames_ left 0
    std::uint64_t alarm_frames_ = 0;     ///< directional: up with every alarm, down with every frame without
    ObserverBank::Outputs samples_;
    ObserverBank::Inputs input_;
};

}  // namespace quorient::fdi
