#include "quorient/voting/voter.hpp"

#include "brain.hpp"

#include <cassert>

namespace quorient::voting {

Voter::Voter(const VoterSettings& settings)
{
    assert(check(settings) && "settings are to be checked first");
    brain_ = std::make_unique<Brain>(settings);
}

Voter::~Voter() = default;
Voter::Voter(Voter&&) noexcept = default;
Voter& Voter::operator=(Voter&&) noexcept = default;

void Voter::on_attitude(const AttitudeState& attitude, std::int64_t now_ns)
{
    brain_->on_attitude(attitude, now_ns);
}
void Voter::on_verdict(const FaultVerdict& verdict, std::int64_t now_ns)
{
    brain_->on_verdict(verdict, now_ns);
}
void Voter::on_other_voter(const VotedAttitude& output, std::int64_t now_ns)
{
    brain_->on_other_voter(output, now_ns);
}
void Voter::poll(std::int64_t now_ns)
{
    brain_->poll(now_ns);
}
std::int64_t Voter::next_deadline_ns() const
{
    return brain_->next_deadline_ns();
}
bool Voter::next_owned(VotedAttitude& output)
{
    return brain_->next_owned(output);
}
bool Voter::next_output(Output& output)
{
    return brain_->next_output(output);
}
bool Voter::next_event(VoterEvent& event)
{
    return brain_->next_event(event);
}
const VoterCounters& Voter::counters() const
{
    return brain_->counters();
}
VoteLevel Voter::level() const
{
    return brain_->level();
}
std::uint32_t Voter::primary_lane() const
{
    return brain_->primary_lane();
}
bool Voter::owns() const
{
    return brain_->owns();
}
bool Voter::may_own() const
{
    return brain_->may_own();
}

}  // namespace quorient::voting
