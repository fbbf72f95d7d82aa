#pragma once

#include "quorient/design/search.hpp"
#include "study.hpp"

#include <string>
#include <vector>

namespace quorient::studies {

/// One claim about a known optimum: what was asked, what the search found by itself, and what is known.
struct Proof {
    std::string asked;
    std::string figure;
    double found = 0;
    double known = 0;
    double bound = 0;  ///< that no array passes; NaN: none
    std::string source;
    double known_to = 1e-6;  ///< the source's digits
};

std::vector<Proof> known_optima(const RunSettings& settings);

/// An array of paper 004 beside the best that the search found for as many sensors of the same kind.
struct Ranked {
    std::string matrix;
    std::string layout;
    int rank_printed = 0;
    int rank = 0;
    double f_d2_printed = 0;
    double f_d2 = 0;  ///< as the paper compares: partner axes of one gyro left out
    double f_d2_best = 0;
    double worst_trace = 0;       ///< after two failures
    double worst_trace_best = 0;
};

std::vector<Ranked> paper_004_ranking(const RunSettings& settings);

/// A choice among places, by every choice and by exchange.
struct Enumerated {
    std::string brief;
    std::string objective;
    std::size_t choices = 0;
    double by_all = 0;
    double by_exchange = 0;
};

std::vector<Enumerated> enumerations(const RunSettings& settings);

/// The probability of surviving ten years against the number of axes, by family.
struct Survey {
    cli::Chart chart;
    double largest_error = 0;  ///< standard error of its Monte Carlo
};

Survey survey(const RunSettings& settings, const OnProgress& on_progress);

}  // namespace quorient::studies
