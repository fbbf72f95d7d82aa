#pragma once

#include "program.hpp"
#include "quorient/system/system.hpp"

#include <memory>
#include <optional>
#include <string>

namespace quorient::cli {

/// `--dds`, `--domain`, `--interface`, `--peer`, `--unit`, `--keys`, `--as`: how a live verb joins the bus.
struct BusOptions {
    std::string dds = "cyclonedds";
    std::optional<std::uint32_t> domain;
    std::string interface = "lo";
    std::vector<std::string> peers;
    std::uint32_t participants_per_host = bus::Settings{}.participants_per_host;
    std::uint32_t unit = 1;
    std::string keys;      ///< directory of `quorient keys`; empty = plain DDS
    std::string identity;  ///< the identity to use; empty = that of the verb's role
    double voted_lease_s = 0.05;  ///< see bus::Settings

    /// @param role  default of `--as`: monitor or operator.
    void add_to(Verb& verb, const std::string& role = "monitor");

    /// The domain that was given, else that of the keys, else 42. @throws Exit{2} where the keys cannot be read.
    std::uint32_t joined_domain() const;

    /// @throws Exit{2} after explaining a bad vendor, domain, interface or key on stderr.
    std::unique_ptr<bus::Bus> open(const std::string& participant) const;
};

/// SYSTEM.yaml with `--dds`, `--domain`, `--set`, `--log`, `--speed`, `--fault`: a system file as a verb reads it.
struct SystemOptions {
    std::string file;
    std::string dds;
    std::optional<std::uint32_t> domain;
    std::vector<std::string> set;
    std::string log;
    std::optional<double> speed;
    std::vector<std::string> faults;

    enum class File { required, optional };

    void add_to(Verb& verb, File file_is = File::required);

    /// As a replay takes them: `--system FILE` instead of a position, no live options.
    void add_replay_to(Verb& verb);

    /// All of it as values of the file.
    std::vector<std::string> assignments() const;

    /// @param joins  false: no keys are needed. @throws Exit{2} after explaining a bad vendor on stderr.
    system::Overrides overrides(bool joins = true) const;

    /// @throws Exit{2} after explaining every problem on stderr.
    system::System load() const;

    /// For verbs that only read the file: no keys are needed.
    system::System load_without_joining() const;

private:
    system::System load(bool joins) const;
};

}  // namespace quorient::cli
