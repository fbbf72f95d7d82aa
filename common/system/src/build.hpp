#pragma once

#include "quorient/configuration/document.hpp"
#include "quorient/system/system.hpp"
#include "sections/file.hpp"

#include <string>
#include <string_view>

namespace quorient::system {

/// The document that a file was read from, to report what is found later at the keys.
class Report {
public:
    Report(const YAML::Node& document, configuration::Problems& problems) : document_(document), problems_(problems) {}

    void at(std::string_view path, std::string_view what) { configuration::report(problems_, document_, path, what); }
    bool stands(std::string_view path) const { return configuration::stands(document_, path); }

private:
    const YAML::Node& document_;
    configuration::Problems& problems_;
};

/// The system that a file describes. What the file leaves open is filled in there. What cannot be becomes a problem at its key.
/// @param name  of the file
System build(const std::string& name, File& file, const Overrides& overrides, Report& report);

/// A file that the system file names, as an absolute path: names count from the folder of the system file, so that every process finds the
/// same file wherever it is started.
std::string beside(const System& system, const std::string& name);

// Its parts.

/// Axes and initial attitude, or a vessel's model.
void build_unit(File& file, System& system, Report& report);
void build_source(File& file, System& system, Report& report);

/// What the processes of this host present to others, where the system is secured.
void build_security(System& system, const Overrides& overrides, Report& report);

/// Names that are taken twice, cannot be names of files, or do not fit into messages.
void check_names(const File& file, Report& report);

/// Compositions whose processes cannot run in one, and names that stand in two.
void check_compositions(const System& system, Report& report);

/// What a unit's methods, observers, integrators and voters refuse.
void check_algorithms(const System& system, Report& report);

}  // namespace quorient::system
