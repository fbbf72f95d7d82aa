#pragma once

#include "aftermath.hpp"
#include "mounting.hpp"
#include "overview.hpp"

#include "quorient/diagnosis/report.hpp"

namespace quorient::diagnosis {

/// Figures that the log gives of all its instruments without comparing them.
std::vector<InstrumentFacts> logged_facts(const recording::Survey& survey);

/// Adds what shows from a first look at a compared instrument.
void add_rest_facts(const Overview& overview, std::size_t m, InstrumentFacts& facts);

/// Adds what comparison with the sound others shows. @param sound  bit m: instrument m
void add_compared_facts(const Overview& overview, const Mountings& mountings, const Aftermath& aftermath, std::size_t m, std::uint32_t sound,
                        InstrumentFacts& facts);

}  // namespace quorient::diagnosis
