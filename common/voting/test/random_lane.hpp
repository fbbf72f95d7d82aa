#pragma once

#include "random_events.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace quorient::voting::test {

/// The frame that a world is at; `clock` counts the frames of all epochs.
struct Moment {
    std::uint64_t epoch = first_epoch;
    std::uint64_t sequence = 0;
    std::uint64_t clock = 0;
};

/// A lane with its detector: what they have found so far, and whether they send it as it is.
struct Lane {
    bool alive = true;
    bool lies = false;
    std::uint32_t manner = 0;
    unsigned initialising = 0;
    std::uint8_t seeded = 0;
    double error_rad = 0;  ///< so far, by sensor faults
    AxisMask isolated = 0;
    AxisMask suspected = 0;
    AxisMask provisional = 0;  ///< left out, not isolated
    bool is_quick = false;     ///< its detector leaves a suspect out provisionally, and goes back to the onset at once
    unsigned suspect_in = never_soon;
    unsigned isolate_in = never_soon;
    std::uint32_t resets = 0;
    Quaternion reset = no_rotation;

    static constexpr unsigned never_soon = 1'000'000;

    void announce(const Quaternion& rotation)
    {
        ++resets;
        reset = rotation;
    }

    /// The lane integrates again without the faulty axis.
    void end_error()
    {
        if (error_rad != 0) announce(turn(-error_rad));
        error_rad = 0;
    }

    /// One frame passes.
    void live(AxisMask faulty)
    {
        if (initialising > 0) --initialising;
        if (faulty == 0) return;
        suspected = suspect_in == 0 || suspect_in == never_soon ? suspected : 0;
        if (suspect_in == 0) suspected = faulty;
        else if (suspect_in < never_soon) --suspect_in;
        if (suspected != 0 && is_quick && (provisional | isolated) == 0) {
            provisional = faulty;
            end_error();
        }
        if (isolate_in == 0 && isolated == 0) {
            isolated = faulty;
            provisional = 0;
            end_error();
        } else if (isolate_in < never_soon && isolate_in > 0) {
            --isolate_in;
        }
        if (((isolated | provisional) & faulty) == 0) error_rad += 1e-3;
    }

    /// What an honest lane sends.
    AttitudeState sample(std::size_t index, const Moment& now) const
    {
        AttitudeState sent = sample_of(index, now.sequence, now.epoch);
        sent.attitude = truth(now.clock);
        sent = moved(sent, error_rad + 1e-7 * static_cast<double>(index));
        sent = leaving_out(isolating(sent, isolated), isolated | provisional, now.sequence);
        sent.suspect_mask = suspected & ~(isolated | provisional);
        sent.seeded = seeded;
        sent.reset_counter = resets;
        sent.reset_rotation = reset;
        if (initialising > 0) sent.mode = octet(AttitudeMode::initialising);
        return sent;
    }

    FaultVerdict verdict(std::size_t index, const Moment& now) const
    {
        const VerdictState state = isolated != 0      ? VerdictState::isolated
                                   : provisional != 0 ? VerdictState::provisional
                                   : suspected != 0   ? VerdictState::suspect
                                                      : VerdictState::healthy;
        FaultVerdict sent = verdict_of(index, now.sequence, state, isolated | provisional | suspected);
        sent.epoch = now.epoch;
        return sent;
    }
};

/// What a lying lane sends in its place.
inline void twist(AttitudeState& sample, std::uint32_t manner, bool may_lie_about_epochs, Random& random)
{
    const double size = std::pow(10.0, -5.0 + 5.0 * static_cast<double>(random() % 1000) / 1000.0);
    switch (manner % 13) {
        case 0:
            sample = moved(sample, size);
            break;
        case 1:
            sample = moved(sample, 0.3);
            break;
        case 2:
            sample.attitude = product(turn(size, 0), turn(3 * size, 1));
            break;
        case 3:
            sample.attitude[random() % 4] = std::numeric_limits<double>::quiet_NaN();
            break;
        case 4:
            sample = moved(sample, size);
            sample.angle_sigma_rad = 10;
            break;
        case 5:
            sample.sequence += random() % 40;
            sample = moved(sample, 0.2);
            break;
        case 6:
            sample.sequence -= std::min<std::uint64_t>(sample.sequence, random() % 90);
            sample = moved(sample, 0.2);
            break;
        case 7:
            sample.isolated_mask = random() % 64;
            sample = moved(sample, 0.2);
            break;
        case 8:
            sample.mode = static_cast<std::uint8_t>(random() % 9);
            sample = moved(sample, 0.2);
            break;
        case 9:
            sample.reset_counter += random() % 3;
            sample.seeded = random() % 2;
            sample = moved(sample, size);
            break;
        case 10:
            sample.suspect_mask = random() % 64;
            sample = moved(sample, size);
            break;
        case 11:
            sample = moved(leaving_out(sample, random() % 64, sample.sequence - std::min<std::uint64_t>(sample.sequence, random() % 9)),
                           size);
            break;
        default:
            if (may_lie_about_epochs) sample.epoch += random() % 5000;
            sample = moved(sample, 0.2);
    }
}

inline void twist(FaultVerdict& verdict, Random& random)
{
    verdict.state = static_cast<std::uint8_t>(random() % 10);
    verdict.isolated_mask = random() % 64;
    verdict.excluded_from.exclude(random() % 64, random() % 200);
    verdict.suspect_mask = random();
    verdict.candidate_count = static_cast<std::uint8_t>(random());
    verdict.candidate_set[random() % max_candidates] = random();
    verdict.sequence += random() % 50;
    verdict.detectable_remaining = static_cast<std::uint8_t>(random() % 2);
}

}  // namespace quorient::voting::test
