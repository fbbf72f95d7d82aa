#pragma once

#include "program.hpp"
#include "quorient/recording/instrument_log.hpp"

#include <optional>
#include <string>

namespace quorient::cli {

/// `--unit`, `--time-unit`, `--lsb-per-deg-s`: what a user says of a table that does not say it itself.
struct LogChoice {
    std::optional<std::string> unit;
    std::optional<std::string> time_unit;
    std::optional<double> lsb_per_deg_s;

    void add_to(Verb& verb);
    recording::LogOptions options() const;
};

}  // namespace quorient::cli
