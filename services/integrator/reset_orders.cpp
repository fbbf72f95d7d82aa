#include "reset_orders.hpp"

#include <fmt/format.h>
#include <cmath>
#include <utility>

namespace quorient::integrator {
namespace {

/// An order on a frame that other lanes have received already waits for it. One further ahead is a mistake.
constexpr double most_frames_ahead = 64;

/// An order whose frame has not come after this time is refused.
constexpr std::int64_t patience_ns = 1'000'000'000;

/// Sequences above this have no exact value as a double.
constexpr double largest_sequence = 9e15;

/// @returns why not; empty if the attitude was reset.
std::string reset(const FaultCommand& command, attitude::Integrator* integrator)
{
    double norm = 0;
    for (const double component : command.attitude) norm += component * component;
    if (!(std::abs(norm - 1) < 1e-6)) return "cannot reset: not a unit quaternion";
    if (!integrator) return "cannot reset: no frame yet";
    const bool is_sequence = command.value >= 0 && command.value < largest_sequence;
    if (!is_sequence || !integrator->reset(command.attitude, static_cast<std::uint64_t>(command.value)))
        return fmt::format("cannot reset: sequence {:.0f} is not in the history", command.value);
    return {};
}

}  // namespace

ResetOrders::ResetOrders(runtime::Node& node)
    : node_(node), timer_(node.loop().timer([this] { refuse_waiting("has not come within a second"); }))
{
}

void ResetOrders::receive(const FaultCommand& command, attitude::Integrator* integrator, Identity newest)
{
    newest_ = newest;
    refuse_waiting("had not come when another order did");
    const double frames_ahead = command.value - static_cast<double>(newest.sequence);
    if (!integrator || !(frames_ahead > 0 && frames_ahead < most_frames_ahead)) return carry_out(command, integrator);
    waiting_ = command;
    timer_.set(node_.clock().steady_ns() + patience_ns);
}

void ResetOrders::on_published(attitude::Integrator& integrator, Identity newest)
{
    newest_ = newest;
    if (waiting_ && static_cast<double>(newest.sequence) >= waiting_->value) carry_out(*std::exchange(waiting_, {}), &integrator);
}

void ResetOrders::carry_out(const FaultCommand& command, attitude::Integrator* integrator)
{
    if (const auto refusal = reset(command, integrator); !refusal.empty()) return refuse(command, refusal);
    node_.report(EventCode::command_done, Severity::info, newest_, 0,
                 fmt::format("attitude reset by command as of sequence {:.0f}", command.value), command.request);
}

void ResetOrders::refuse(const FaultCommand& command, const std::string& why)
{
    node_.report(EventCode::command_refused, Severity::warning_low, newest_, 0, why, command.request);
}

void ResetOrders::refuse_waiting(const char* what_became_of_its_frame)
{
    const auto command = std::exchange(waiting_, {});
    if (command) refuse(*command, fmt::format("cannot reset: sequence {:.0f} {}", command->value, what_became_of_its_frame));
}

}  // namespace quorient::integrator
