#pragma once

#include "guaranteed_programs.hpp"
#include "single_frame/guaranteed_detector.hpp"

#include <cstddef>
#include <vector>

namespace quorient::fdi {

/// How far the closed form and the linear programs differ over many frames.
struct Comparison {
    std::size_t frames = 0;
    std::size_t empty = 0;            ///< by both
    std::size_t at_the_boundary = 0;  ///< within 1e-5 sigma of where some pair turns infeasible: not compared
    std::size_t emptiness_differs = 0;
    double largest_difference = 0;  ///< between the ends of the intervals [unit of z]
};

/// @param bound  sigma, of the detector and the programs alike.
Comparison compare(GuaranteedDetector& detector, GuaranteedPrograms& programs, const geometry::Axes& axes, double bound,
                   const std::vector<std::vector<double>>& frames);

}  // namespace quorient::fdi
