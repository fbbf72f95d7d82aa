#pragma once

#include "quorient/bus/bus.hpp"

#include <memory>

namespace quorient::bus {

/// Connects the local buses of one process. In-process, one thread, deterministic: samples arrive in the order written.
class LocalHub {
public:
    LocalHub();
    ~LocalHub();
    LocalHub(const LocalHub&) = delete;
    LocalHub& operator=(const LocalHub&) = delete;

    /// A bus over this hub; it may outlive the hub.
    std::unique_ptr<Bus> open();

    struct State;

private:
    std::shared_ptr<State> state_;
};

}  // namespace quorient::bus
