#pragma once

#include "quorient/bus/security.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace quorient::latency {

/// The hot topics' types.
enum class Type { frame, verdict, attitude, voter_output };

/// How a floor joins DDS: the vendor's defaults, with the hot topics' QoS (idl/README.md) on loopback.
struct RawSettings {
    std::uint32_t domain = 0;
    bool shared_memory = false;
    std::optional<bus::SecurityFiles> security = std::nullopt;
};

/// Straight on a vendor's API: what a hop costs without the bus. Samples are the plain structs of common/messages.
class RawWriter {
public:
    virtual ~RawWriter() = default;
    virtual void write(const void* sample) = 0;
    virtual std::uint32_t matched() = 0;
};

class RawReader {
public:
    virtual ~RawReader() = default;
    virtual bool take(void* sample) = 0;
    virtual std::uint32_t matched() = 0;
};

class Raw {
public:
    virtual ~Raw() = default;
    virtual std::unique_ptr<RawWriter> writer(Type type, const char* topic) = 0;
    virtual std::unique_ptr<RawReader> reader(Type type, const char* topic) = 0;
    /// Until a reader may have data.
    virtual void wait(std::int64_t timeout_ns) = 0;
};

std::unique_ptr<Raw> open_raw_cyclonedds(const RawSettings& settings);
std::unique_ptr<Raw> open_raw_fastdds(const RawSettings& settings);

}  // namespace quorient::latency
