#pragma once

#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace quorient::bus {

/// Carries what DDS Security refused from a vendor's threads to the service's thread.
class Refusals {
public:
    /// Keeps each text once, at most a hundred of them: a refused peer tries again, and an attacker may use any number of names.
    void add(std::string text);

    /// The texts added since the last call.
    std::vector<std::string> take();

private:
    static constexpr std::size_t most = 100;

    std::mutex mutex_;
    std::set<std::string> known_;
    std::vector<std::string> new_;
};

}  // namespace quorient::bus
