#include "quorient/bus/refusals.hpp"

#include <utility>

namespace quorient::bus {

void Refusals::add(RefusalReason reason, std::string text)
{
    const std::lock_guard lock{mutex_};
    if (known_.size() == most || !known_.insert(text).second) return;
    new_.push_back({reason, std::move(text)});
}

std::vector<Refusal> Refusals::take()
{
    const std::lock_guard lock{mutex_};
    return std::exchange(new_, {});
}

}  // namespace quorient::bus
