#pragma once

#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace quorient::bus {

/// Why samples of another participant, or the participant itself, are not accepted.
enum class RefusalReason { security, other_contract };

/// For an operator, partly in the vendor's language.
struct Refusal {
    RefusalReason reason = RefusalReason::security;
    std::string text;
};

/// Carries refusals from a vendor's threads to the service's thread.
class Refusals {
public:
    /// Keeps each text once, at most a hundred of them: a refused peer tries again, and an attacker may use any number of names.
    void add(RefusalReason reason, std::string text);

    /// Those added since the last call.
    std::vector<Refusal> take();

private:
    static constexpr std::size_t most = 100;

    std::mutex mutex_;
    std::set<std::string> known_;
    std::vector<Refusal> new_;
};

}  // namespace quorient::bus
