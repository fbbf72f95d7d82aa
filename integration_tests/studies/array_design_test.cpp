#include "array_design.hpp"

#include <gtest/gtest.h>
#include <cmath>

namespace quorient::studies {
namespace {

const RunSettings quick{1000, 1, 0};

TEST(KnownOptima, are_found_and_no_bound_is_passed)
{
    for (const Proof& proof : known_optima(quick)) {
        EXPECT_NEAR(proof.found, proof.known, proof.known_to) << proof.asked << ", " << proof.figure;
        if (!std::isfinite(proof.bound)) continue;
        const bool more_is_better = proof.figure.starts_with("F_") || proof.figure.starts_with("smallest");
        EXPECT_GE(more_is_better ? proof.bound / proof.found : proof.found / proof.bound, 1 - 1e-9) << proof.asked << ", " << proof.figure;
    }
}

TEST(Paper004, is_ranked_as_printed_and_no_array_of_it_beats_the_search)
{
    const auto rows = paper_004_ranking(quick);
    ASSERT_EQ(rows.size(), 11U);
    for (const Ranked& row : rows) {
        EXPECT_EQ(row.rank, row.rank_printed) << row.matrix;
        if (row.f_d2_best > 0) {
            EXPECT_GE(row.f_d2_best, row.f_d2 * (1 - 1e-6)) << row.matrix;
        }
    }
}

TEST(Enumeration, agrees_with_the_exchange_search)
{
    for (const Enumerated& row : enumerations(quick)) EXPECT_NEAR(row.by_exchange, row.by_all, 1e-9) << row.brief << ", " << row.objective;
}

}  // namespace
}  // namespace quorient::studies
