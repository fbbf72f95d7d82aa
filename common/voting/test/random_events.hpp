#pragma once

#include <gtest/gtest.h>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

namespace quorient::voting::test {

/// SplitMix64 (Steele, Lea & Flood 2014): a seed per event costs nothing.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint32_t operator()()
    {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
    }

private:
    std::uint64_t state_;
};

enum class Happening : std::uint8_t {
    frame,
    kill,
    revive,
    lie,
    honest,
    sensor_fault,
    readmit,
    pause,
    restart_publisher,
    stall,
    standstill,  ///< All voters stop.
    kill_voter,
    revive_voter
};

struct Event {
    Happening what = Happening::frame;
    std::uint32_t where = 0;  ///< lane or voter
    std::uint32_t how = 0;    ///< seeds everything random within the event, so that shrinking others does not change it
};

inline std::ostream& operator<<(std::ostream& out, const Event& event)
{
    static constexpr std::array names{
        "frame", "kill",       "revive",      "lie", "honest", "sensor_fault", "readmit", "pause", "restart_publisher",
        "stall", "standstill", "kill_voter", "revive_voter"};
    return out << names[static_cast<std::size_t>(event.what)] << '(' << event.where << ',' << event.how << ')';
}

using Events = std::vector<Event>;

using Rule = std::function<std::string(const Events&)>;
using Generator = std::function<Events(Random&)>;

inline std::string shown(const Events& events)
{
    std::ostringstream out;
    std::size_t frames = 0;
    for (const Event& event : events) {
        frames += event.what == Happening::frame ? 1 : 0;
        if (event.what != Happening::frame) out << "\n  after " << frames << " frames: " << event;
    }
    out << "\n  " << frames << " frames in all; the whole sequence:";
    for (const Event& event : events) out << ' ' << event;
    return out.str();
}

/// Leaves out ever smaller parts while the rule stays broken.
inline Events shrunk(Events events, const Rule& rule)
{
    for (std::size_t part = events.size() / 2; part > 0; part /= 2) {
        for (std::size_t from = 0; from + part <= events.size();) {
            Events fewer = events;
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(from), fewer.begin() + static_cast<std::ptrdiff_t>(from + part));
            if (!rule(fewer).empty()) events = std::move(fewer);
            else from += part;
        }
    }
    return events;
}

inline std::uint64_t number(const char* name, std::uint64_t otherwise)
{
    const char* text = std::getenv(name);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// A fifth of all sequences for each of the five rules.
inline void hold(const Generator& generate, const Rule& rule)
{
    const std::uint64_t first = number("QUORIENT_RANDOM_SEED", 1);
    const std::uint64_t sequences = number("QUORIENT_RANDOM_SEQUENCES", 5000) / 5;
    for (std::uint64_t seed = first; seed < first + sequences; ++seed) {
        Random random(seed * 2654435761U);
        const Events events = generate(random);
        const std::string problem = rule(events);
        if (problem.empty()) continue;
        const Events small = shrunk(events, rule);
        FAIL() << "seed " << seed << ": " << problem << "; shrunk: " << rule(small) << shown(small);
    }
}

inline Happening any_of(Random& random, std::initializer_list<Happening> choice)
{
    return *(choice.begin() + random() % choice.size());
}

inline Events mixed(Random& random, std::size_t length, unsigned every, std::initializer_list<Happening> choice)
{
    Events events;
    for (std::size_t at = 0; at < length; ++at) {
        const Happening what = random() % every == 0 ? any_of(random, choice) : Happening::frame;
        events.push_back({what, random() % 8, random()});
    }
    return events;
}

}  // namespace quorient::voting::test
