#pragma once

#include <cstdint>

namespace quorient::runtime {

/// Time, injected. Staleness is judged by the steady clock, never by a wall clock.
class Clock {
public:
    virtual ~Clock() = default;
    virtual std::int64_t steady_ns() const = 0;
    virtual std::int64_t wall_ns() const = 0;  ///< since 1970, for people and for epochs
};

/// The machine's clocks. Readings of the steady clock compare between processes of one host.
class SystemClock final : public Clock {
public:
    std::int64_t steady_ns() const override;
    std::int64_t wall_ns() const override;
};

/// Time that moves only when it is set: replay and tests.
class VirtualClock final : public Clock {
public:
    std::int64_t steady_ns() const override { return now_ns_; }
    std::int64_t wall_ns() const override { return now_ns_; }
    void set(std::int64_t now_ns) { now_ns_ = now_ns; }

private:
    std::int64_t now_ns_ = 0;
};

}  // namespace quorient::runtime
