// Deterministic runs of every target in the ordinary test run: input N is always the same one. The same targets run under libFuzzer
// with -DQUORIENT_LIBFUZZER=ON (clang); README.md.

#include "run.hpp"
#include "targets.hpp"

#include <gtest/gtest.h>

namespace quorient::fuzz {

namespace {

TEST(Fuzz, frames_and_descriptions_of_any_kind_break_no_promise_of_detector_and_integrator)
{
    run("frames", frames, 300, 6000);
}

TEST(Fuzz, attitudes_verdicts_and_voters_of_any_kind_break_no_promise_of_the_voter)
{
    run("votes", votes, 600, 3000);
}

TEST(Fuzz, imu_messages_of_any_kind_give_finite_frames_in_order)
{
    run("imus", imus, 300, 6000);
}

TEST(Fuzz, bytes_of_any_kind_are_decoded_or_refused)
{
    run("decode", decode, 3000, 4096);
}

}  // namespace

}  // namespace quorient::fuzz
