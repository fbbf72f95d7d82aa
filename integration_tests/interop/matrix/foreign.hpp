#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace foreign {

/// What an endpoint asks for or offers.
struct Wish {
    bool reliable = true;
    bool transient_local = false;
    bool exclusive = false;  ///< a writer's with MANUAL_BY_TOPIC liveliness, as the contract has it
    int depth = 64;
    std::uint32_t reader_lease_ns = 0;  ///< a reader asks for MANUAL_BY_TOPIC liveliness with this lease; 0: for none
    std::string partition{};
    bool other_type = false;  ///< the topic's name with another type of the IDL
};

struct Sample {
    std::uint32_t unit = 0;
    std::uint64_t sequence = 0;
};

/// A writer or reader of VotedAttitude made with the vendor's own interface, none of ours in between.
class Endpoint {
public:
    virtual ~Endpoint() = default;
    virtual std::uint32_t matched() = 0;
    virtual bool write(const Sample& sample) = 0;
    virtual bool take(Sample& sample) = 0;
};

/// A participant, on loopback.
class Node {
public:
    virtual ~Node() = default;
    virtual std::unique_ptr<Endpoint> writer(const std::string& topic, const Wish& wish) = 0;
    virtual std::unique_ptr<Endpoint> reader(const std::string& topic, const Wish& wish) = 0;
};

std::unique_ptr<Node> plain_cyclonedds(std::uint32_t domain);
std::unique_ptr<Node> plain_fastdds(std::uint32_t domain);

/// Keeps Fast DDS participants of one process from handing samples over in memory: here everything must go by the wire.
void fastdds_by_the_wire();

}  // namespace foreign
