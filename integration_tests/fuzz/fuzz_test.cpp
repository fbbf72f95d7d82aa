// Deterministic runs of every target in the ordinary test run: as many inputs as fit a few seconds, always the same ones. The same
// targets run under libFuzzer with -DQUORIENT_LIBFUZZER=ON (clang); README.md.

#include "targets.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>
#include <vector>

namespace quorient::fuzz {

namespace {

std::size_t resident_kb()
{
    std::ifstream statm{"/proc/self/statm"};
    std::size_t pages = 0, resident = 0;
    statm >> pages >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) / 1024;
}

/// QUORIENT_FUZZ_SCALE multiplies the inputs, for longer runs.
void run(void (*target)(const std::uint8_t*, std::size_t), std::uint64_t inputs, std::size_t longest)
{
    if (const char* scale = std::getenv("QUORIENT_FUZZ_SCALE")) inputs *= static_cast<std::uint64_t>(std::max(1, std::atoi(scale)));
    std::vector<std::uint8_t> input(longest);
    std::size_t warm_kb = 0;
    for (std::uint64_t seed = 0; seed < inputs; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        std::mt19937_64 random{seed};
        input.resize(1 + random() % longest);
        for (auto& byte : input) byte = static_cast<std::uint8_t>(random());
        target(input.data(), input.size());
        if (seed == inputs / 4) warm_kb = resident_kb();
    }
    EXPECT_LT(resident_kb(), warm_kb + 4096) << "it grows";
}

TEST(Fuzz, frames_and_descriptions_of_any_kind_break_no_promise_of_detector_and_integrator)
{
    run(frames, 300, 6000);
}

TEST(Fuzz, attitudes_verdicts_and_voters_of_any_kind_break_no_promise_of_the_voter)
{
    run(votes, 600, 3000);
}

TEST(Fuzz, imu_messages_of_any_kind_give_finite_frames_in_order)
{
    run(imus, 300, 6000);
}

TEST(Fuzz, bytes_of_any_kind_are_decoded_or_refused)
{
    run(decode, 3000, 4096);
}

}  // namespace

}  // namespace quorient::fuzz
