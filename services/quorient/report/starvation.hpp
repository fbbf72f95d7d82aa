#pragma once

#include "quorient/messages/health_event.hpp"
#include "quorient/messages/service_status.hpp"

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace quorient::report {

/// Two statuses of one service: what it did between them.
struct Interval {
    ServiceStatus first;
    ServiceStatus latest;

    bool is_measured() const;  ///< time passed, in one process
    double rate_hz() const;    ///< samples published; 0 where it is not measured
    double elapsed_s() const;
};

/// A service that does not give out what the sensor gives in.
struct Starving {
    std::string service;
    double rate_hz = 0;
    double sensor_hz = 0;
    bool sheds = false;  ///< by its own decision
};

/// The detectors, integrators and voters that published less than 95 % as many samples as the sensor sent frames, and lack more frames than
/// two counts of different moments may differ by. Where no sensor answers, the quickest service stands in for it. One that had published
/// nothing at the first status has only begun, and is not judged.
/// @param events  of these services; OVERLOADED says which of them leave frames out
std::vector<Starving> find_starving(std::span<const Interval> services, std::span<const HealthEvent> events);

/// One line each.
std::string starving_text(std::span<const Starving> starving);
nlohmann::ordered_json starving_json(std::span<const Starving> starving);

}  // namespace quorient::report
