#pragma once

#include "scene.hpp"

#include <algorithm>

namespace quorient::voting::test {

/// Two voters that receive the same lanes and each other.
struct Pair {
    Pair() : strong(settings_of(3, {1, 2}, 1)), weak(settings_of(3, {1, 2}, 2)) {}

    void deliver(Scene& to, const AttitudeState& sample, std::int64_t time)
    {
        to.at(time, sample);
        exchange();
    }

    void exchange()
    {
        for (; strong_alive && strong_delivered < strong.outputs.size(); ++strong_delivered) deliver_output(weak, weak_alive, strong.outputs[strong_delivered]);
        for (; weak_alive && weak_delivered < weak.outputs.size(); ++weak_delivered) deliver_output(strong, strong_alive, weak.outputs[weak_delivered]);
    }

    void deliver_output(Scene& scene, bool alive, const VotedAttitude& output) const
    {
        if (alive) scene.at(std::max(weak.now, strong.now), output);
    }

    template <class Change>
    void frames(std::uint64_t first, std::uint64_t last, Change&& change)
    {
        for (std::uint64_t sequence = first; sequence <= last; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) {
                const std::int64_t time = Scene::time_of(sequence) + static_cast<std::int64_t>(lane) * ms / 10;
                AttitudeState sample = sample_of(lane, sequence);
                if (!change(lane, sample)) continue;
                if (strong_alive) deliver(strong, sample, time);
                if (weak_alive) deliver(weak, sample, time + ms / 50);
            }
        }
    }

    void frames(std::uint64_t first, std::uint64_t last)
    {
        frames(first, last, [](std::size_t, AttitudeState&) { return true; });
    }

    Scene strong, weak;
    std::size_t strong_delivered = 0, weak_delivered = 0;
    bool strong_alive = true, weak_alive = true;
};

}  // namespace quorient::voting::test
