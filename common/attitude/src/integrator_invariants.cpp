// What must hold between the parts of an integrator after every call. Tests ask for it; nothing here runs in a process.

#include "announcement.hpp"
#include "frame_stream.hpp"
#include "integration.hpp"
#include "quorient/attitude/integrator.hpp"
#include "start.hpp"
#include "trust.hpp"

namespace quorient::attitude {
namespace {

const char* broken_record(const Record& record)
{
    if (record.first_sequence > record.last_sequence) return "a record ends before it begins";
    if (!record.bridge && record.first_sequence != record.last_sequence) return "a frame's record covers more than one frame";
    if (!(record.interval_s > 0)) return "a record has no interval";
    if ((record.judgement.used & ~record.valid) != 0) return "an axis is used that is not valid";
    if ((record.isolated & ~record.excluded) != 0) return "an axis is isolated and not excluded";
    if ((record.opinion.isolated & ~record.opinion.excluded) != 0) return "an opinion isolates an axis that it does not exclude";
    if (record.own_opinion && (record.opinion.sequence < record.first_sequence || record.opinion.sequence > record.last_sequence))
        return "a record has an opinion of its own that is on another frame";
    return nullptr;
}

const char* broken_history(const History& history, const FrameStream& stream)
{
    for (std::size_t i = 0; i < history.size(); ++i) {
        if (const char* broken = broken_record(history[i])) return broken;
        if (i > 0 && history[i].first_sequence != history[i - 1].last_sequence + 1) return "frames are missing between two records";
    }
    if (!history.empty() && !stream.has_epoch()) return "there are records before the first frame";
    if (!history.empty() && history.newest().last_sequence + 1 != stream.next_sequence())
        return "the next frame does not follow the newest record";
    return nullptr;
}

bool same(const Standing& a, const Standing& b)
{
    return a.attitude.coeffs() == b.attitude.coeffs() && a.variance == b.variance && a.systematic_rad == b.systematic_rad &&
           a.alignment == b.alignment;
}

}  // namespace

const char* Integrator::broken_invariant() const
{
    if (const char* broken = broken_history(*history_, *stream_)) return broken;
    if (const char* broken = integration_->broken_invariant(*history_)) return broken;
    if (announcement_->unpublished() > history_->size()) return "more frames are unpublished than there are";
    for (std::size_t i = 0; settings_.rollback && i < history_->size(); ++i) {
        const Record& record = (*history_)[i];
        if (record.judgement != judge(record.opinion, record.excluded, record.valid, settings_.leave_out_suspects, body_))
            return "a record was integrated with other axes than its verdicts ask for";
    }
    const bool caught_up = integration_->has_caught_up(*history_);
    if (caught_up && !same(announcement_->shown(), history_->standing_before(history_->size())))
        return "nothing is pending, and what is shown is not the newest standing";
    if (start_->is_catching_up() && caught_up && !history_->empty()) return "the start is catching up, and there is nothing left to do";
    if (stream_->knowledge() == FrameStream::Knowledge::place && !history_->empty()) return "frames came, and their angles are not known";
    if (stream_->knowledge() == FrameStream::Knowledge::place && start_->state() != StartState::taking_over)
        return "the place in the stream is from a seed, and no seed was taken over";
    if (verdict_applied_.epoch > stream_->epoch()) return "a verdict of an epoch to come was applied";
    return nullptr;
}

}  // namespace quorient::attitude
