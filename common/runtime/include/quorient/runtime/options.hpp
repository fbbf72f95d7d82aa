#pragma once

#include "quorient/messages/codes.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::runtime {

/// The system file that a process is of, and what holds in place of the file.
struct SystemChoice {
    std::string system_file;
    std::optional<Vendor> dds;
    std::optional<std::uint32_t> domain;
    std::vector<std::string> set;  ///< values in place of the file's
};

/// The command line of every service.
struct Options : SystemChoice {
    std::string name;  ///< this process's in the system file
};

/// A flag of one service alone: given, it sets a value of the system file.
struct Switch {
    std::string name;        ///< "--allow-orders"
    std::string help;        ///< one sentence
    std::string assignment;  ///< as --set takes it
};

struct OptionsError {
    int exit_code;  ///< 0 after --help or --version, 2 after a mistake; either is already explained
};

/// Reads SYSTEM.yaml [--name NAME] [--dds VENDOR] [--domain N] [--set KEY=VALUE …]; --help shows an example.
/// @param default_name  the service's own name where a system has just one of its role; empty = --name is required.
tl::expected<Options, OptionsError> parse_options(int argc, char** argv, const std::string& description, const std::string& default_name,
                                                  const std::vector<Switch>& switches = {});

/// The version of this build.
std::string version();

}  // namespace quorient::runtime
