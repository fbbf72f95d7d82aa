#pragma once

#include "quorient/attitude/integrator.hpp"
#include "quorient/messages/fault_command.hpp"
#include "quorient/runtime/node.hpp"

#include <optional>
#include <string>

namespace quorient::integrator {

/// Orders to reset the attitude. An order states the attitude at the end of one frame. Other lanes may have received that frame already, so
/// an order may have to wait for it. Each order is answered once.
class ResetOrders {
public:
    enum class State {
        /// Every order has its answer.
        idle,
        /// One order waits for its frame. It is carried out with that frame, and refused after a second or when another order comes.
        waiting,
    };

    explicit ResetOrders(runtime::Node& node);

    State state() const { return waiting_ ? State::waiting : State::idle; }

    /// @param integrator  nullptr while there is none. @param newest  the newest frame published
    void receive(const FaultCommand& command, attitude::Integrator* integrator, Identity newest);

    /// This frame is published; it may be the one that an order waits for.
    void on_published(attitude::Integrator& integrator, Identity newest);

private:
    void carry_out(const FaultCommand& command, attitude::Integrator* integrator);
    void refuse(const FaultCommand& command, const std::string& why);
    void refuse_waiting(const char* what_became_of_its_frame);

    runtime::Node& node_;
    runtime::Timer& timer_;
    std::optional<FaultCommand> waiting_;
    Identity newest_;  ///< published, as of the last call
};

}  // namespace quorient::integrator
