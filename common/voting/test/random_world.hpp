#pragma once

#include "random_events.hpp"
#include "random_lane.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace quorient::voting::test {

/// Checks what must hold for every output of one voter, whatever happens.
class Watch {
public:
    std::string problem;

    /// @param published  what any voter has given out for this frame before; a voter that was away repeats what the other one
    /// published meanwhile
    void see(const VotedAttitude& now, const Quaternion* published)
    {
        const bool repeated = now.vouching_mask == 0;
        expect(is_attitude(now.attitude) && is_attitude(now.reset_rotation), "an output that is no attitude");
        expect(std::isfinite(now.angle_sigma_rad) && std::isfinite(now.spread_rad) && std::isfinite(now.rate_rad_s[0]), "not finite");
        expect((now.excluded_mask >> (now.primary_lane - 1) & 1U) == 0, "an excluded lane is the primary");
        expect(now.level >= 1 && now.level <= 5, "an unknown level");
        if (before_) {
            expect(now.output_sequence > before_->output_sequence, "output_sequence does not increase");
            expect(repeated ? identity_of(now) >= identity_of(*before_) : identity_of(now) > identity_of(*before_),
                   "the identity steps back");
            expect(!repeated || (published != nullptr && now.attitude == *published), "coasting invents an attitude");
        }
        before_ = now;
    }

    void expect(bool holds, const char* what)
    {
        if (!holds && problem.empty()) problem = what;
    }

    const std::optional<VotedAttitude>& last() const { return before_; }
    void forget() { before_.reset(); }

private:
    std::optional<VotedAttitude> before_;
};

/// What one sequence is about.
struct Profile {
    std::size_t lanes = 3;
    bool liars_may_lie_about_epochs = true;
    std::uint32_t jitter_us = 4000;
    std::size_t voters = 1;
    unsigned return_frames = 15;
};

/// Lanes, detectors and voters, driven by events.
class World {
public:
    explicit World(const Profile& profile) : profile_(profile), lanes_(profile.lanes), voters_(profile.voters), watches_(profile.voters)
    {
        for (std::size_t voter = 0; voter < voters_.size(); ++voter) start_voter(voter);
    }

    std::function<void(std::size_t voter, const VotedAttitude&)> on_output = [](std::size_t, const VotedAttitude&) {};
    std::function<void(std::size_t voter, const VotedAttitude&)> on_owned = [](std::size_t, const VotedAttitude&) {};

    void play(const Event& event)
    {
        Random random(event.how);
        const std::size_t where = event.where % lanes_.size();
        Lane& lane = lanes_[where];
        switch (event.what) {
            case Happening::frame:
                frame(random);
                break;
            case Happening::kill:
                lane.alive = false;
                break;
            case Happening::revive:
                revive(lane, random);
                break;
            case Happening::lie:
                lane.lies = true;
                lane.manner = event.how;
                break;
            case Happening::honest:
                lane.lies = false;
                break;
            case Happening::sensor_fault:
                sensor_fault(random);
                break;
            case Happening::readmit:
                readmit();
                break;
            case Happening::pause:
                now_ += interval * static_cast<std::int64_t>(1 + random() % 40);
                break;
            case Happening::restart_publisher:
                restart_publisher();
                break;
            case Happening::stall:
                stall(event.where % voters_.size(), random);
                break;
            case Happening::standstill:
                standstill(random);
                break;
            case Happening::kill_voter:
                kill_voter(event.where % voters_.size());
                break;
            case Happening::revive_voter:
                revive_voter(event.where % voters_.size());
                break;
        }
    }

    void end_all_causes()
    {
        readmit();
        for (Lane& lane : lanes_) {
            lane.lies = false;
            if (!lane.alive) {
                Random random(1);
                revive(lane, random);
            }
        }
    }

    Watch& watch(std::size_t voter = 0) { return watches_[voter]; }
    const std::string& problem() const
    {
        for (const Watch& watch : watches_) {
            if (!watch.problem.empty()) return watch.problem;
        }
        return none_;
    }
    Identity newest() const { return {frame_.epoch, frame_.sequence - 1}; }
    std::int64_t now() const { return now_; }
    const Lane& lane(std::size_t index) const { return lanes_[index]; }
    std::vector<Lane>& lanes() { return lanes_; }
    const Voter& voter(std::size_t index) const { return *voters_[index].voter; }
    const StatesSeen& states(std::size_t index) const { return voters_[index].states; }

private:
    struct Process {
        std::unique_ptr<Voter> voter;
        std::int64_t started = 0;
        std::int64_t stopped_until = 0;
        unsigned messages_until_stop = 0;  ///< It stops when it has decided about so many, before it writes; 0 = it does not.
        std::int64_t stop_ns = 0;          ///< For so long.
        std::vector<std::pair<std::int64_t, std::variant<AttitudeState, FaultVerdict, VotedAttitude>>> queue;
        StatesSeen states;
    };
    using Message = std::variant<AttitudeState, FaultVerdict, VotedAttitude>;

    /// Long enough for a voter to synchronise (one lease) and to own (20 frames).
    static constexpr std::int64_t start_up = 200 * ms;

    bool is_in_service(std::size_t voter) const
    {
        return voters_[voter].voter != nullptr && now_ - std::max(voters_[voter].started, voters_[voter].stopped_until) > start_up;
    }

    void start_voter(std::size_t index)
    {
        VoterSettings settings = settings_of(lanes_.size());
        settings.return_frames = profile_.return_frames;
        settings.voter = static_cast<std::uint32_t>(index) + 1;
        for (std::uint32_t voter = 1; profile_.voters > 1 && voter <= profile_.voters; ++voter) settings.voters.push_back(voter);
        voters_[index] = {};
        voters_[index].voter = std::make_unique<Voter>(settings);
        voters_[index].started = now_;
        voters_[index].voter->poll(now_);
    }

    void kill_voter(std::size_t index)
    {
        for (std::size_t other = 0; other < voters_.size(); ++other) {
            if (other != index && !is_in_service(other)) return;  // one at a time
        }
        voters_[index].voter.reset();
    }

    void revive_voter(std::size_t index)
    {
        if (voters_[index].voter != nullptr) return;
        start_voter(index);
        watches_[index].forget();
    }

    void stall(std::size_t index, Random& random)
    {
        for (std::size_t other = 0; other < voters_.size(); ++other) {
            if (other != index && !is_in_service(other)) return;
        }
        if (voters_[index].voter == nullptr) return;
        const auto stop_ns = ms * static_cast<std::int64_t>(random() % 200);
        if (voters_.size() > 1 && random() % 2 == 0) {
            voters_[index].messages_until_stop = 1 + static_cast<unsigned>(random() % 8);
            voters_[index].stop_ns = stop_ns;
            return;
        }
        voters_[index].stopped_until = now_ + stop_ns;
        if (voters_.size() == 1) now_ = std::max(now_, voters_[index].stopped_until);
    }

    /// The machine: its processes go on one after the other.
    void standstill(Random& random)
    {
        for (std::size_t voter = 0; voter < voters_.size(); ++voter) {
            if (!is_in_service(voter)) return;
        }
        const auto still_ns = ms * static_cast<std::int64_t>(random() % 150);
        for (Process& process : voters_) process.stopped_until = now_ + still_ns + ms / 10 * static_cast<std::int64_t>(random() % 100);
    }

    void revive(Lane& lane, Random& random)
    {
        if (lane.alive) return;
        const AxisMask faulty = faulty_;
        lane = {};
        lane.seeded = 1;
        lane.initialising = random() % 8;
        lane.isolated = faulty;  // it takes over what was isolated
        lane.suspect_in = lane.isolate_in = Lane::never_soon;
    }

    void sensor_fault(Random& random)
    {
        if (faulty_ != 0) return;
        faulty_ = axis_bit(random() % 6);
        for (Lane& lane : lanes_) {
            lane.suspect_in = random() % 6;
            lane.isolate_in = lane.suspect_in + random() % 20;
            lane.is_quick = random() % 2 == 0;
        }
    }

    void readmit()
    {
        faulty_ = 0;
        for (Lane& lane : lanes_) {
            lane.end_error();
            lane.isolated = lane.suspected = lane.provisional = 0;
            lane.suspect_in = lane.isolate_in = Lane::never_soon;
        }
    }

    void restart_publisher()
    {
        now_ += 200 * ms;
        frame_.epoch += 1000;
        frame_.sequence = 0;
    }

    void frame(Random& random)
    {
        now_ += interval;
        std::vector<std::pair<std::int64_t, Message>> sent;
        for (std::size_t index = 0; index < lanes_.size(); ++index) {
            Lane& lane = lanes_[index];
            lane.live(faulty_);
            if (!lane.alive) continue;
            AttitudeState sample = lane.sample(index, frame_);
            FaultVerdict verdict = lane.verdict(index, frame_);
            const std::int64_t time = now_ + 1000 * static_cast<std::int64_t>(random() % profile_.jitter_us);
            const std::int64_t verdict_time = now_ + 1000 * static_cast<std::int64_t>(random() % profile_.jitter_us);
            if (lane.lies) {
                twist(sample, lane.manner, profile_.liars_may_lie_about_epochs, random);
                if (random() % 2 == 0) twist(verdict, random);
                if (random() % 5 == 0) sent.emplace_back(time, sample);  // and again
            }
            sent.emplace_back(time, sample);
            sent.emplace_back(verdict_time, verdict);
        }
        std::stable_sort(sent.begin(), sent.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        const std::int64_t start = now_;
        for (const auto& [time, message] : sent) {
            now_ = time;
            for (std::size_t voter = 0; voter < voters_.size(); ++voter) deliver(voter, message);
        }
        now_ = start;
        ++frame_.sequence;
        ++frame_.clock;
    }

    /// Runs the voter up to now, then hands the message in. A voter that is stopped finds it in its queue when it wakes, topic by topic in
    /// the order in which the process reads them, and before any of its timers.
    void deliver(std::size_t index, const Message& message)
    {
        Process& process = voters_[index];
        if (process.voter == nullptr) return;
        if (process.stopped_until > now_) {
            process.queue.emplace_back(now_, message);
            return;
        }
        if (process.stopped_until > process.started) {
            process.started = process.stopped_until;
            collect(index);
            auto waiting = std::move(process.queue);
            process.queue.clear();
            // Other voters, verdicts, attitudes: the alternatives from the last to the first.
            std::stable_sort(waiting.begin(), waiting.end(),
                             [](const auto& a, const auto& b) { return a.second.index() > b.second.index(); });
            for (const auto& [time, queued] : waiting) hand_in(index, queued, now_);
            process.voter->poll(now_);
            collect(index);
        }
        run(index, now_);
        hand_in(index, message, now_);
    }

    void run(std::size_t index, std::int64_t until)
    {
        Voter& voter = *voters_[index].voter;
        while (voter.next_deadline_ns() <= until) {
            const std::int64_t deadline = voter.next_deadline_ns();
            voter.poll(deadline);
            collect(index);
            watches_[index].expect(voter.next_deadline_ns() > deadline, "a deadline that does not pass");
            if (voter.next_deadline_ns() <= deadline) return;
        }
    }

    void hand_in(std::size_t index, const Message& message, std::int64_t time)
    {
        Voter& voter = *voters_[index].voter;
        if (const auto* sample = std::get_if<AttitudeState>(&message)) voter.on_attitude(*sample, time);
        if (const auto* verdict = std::get_if<FaultVerdict>(&message)) voter.on_verdict(*verdict, time);
        if (const auto* output = std::get_if<VotedAttitude>(&message)) voter.on_other_voter(*output, time);
        collect(index);
    }

    void collect(std::size_t index)
    {
        Process& process = voters_[index];
        if (process.messages_until_stop > 0 && --process.messages_until_stop == 0) {
            process.stopped_until = now_ + process.stop_ns;
            return;
        }
        const char* broken = voters_[index].voter->broken_invariant();
        watches_[index].expect(broken == nullptr, broken);
        watches_[index].expect(voters_[index].states.see(voters_[index].voter->state()), "a change of state that is not drawn");
        VotedAttitude output;
        VoterEvent event;
        VotedAttitude owned;
        while (voters_[index].voter->next_event(event)) continue;
        while (voters_[index].voter->next_owned(owned, now_)) on_owned(index, owned);
        while (voters_[index].voter->next_output(output)) {
            const auto published = published_.find(identity_of(output));
            watches_[index].see(output, published == published_.end() ? nullptr : &published->second);
            published_.insert_or_assign(identity_of(output), output.attitude);
            on_output(index, output);
            for (std::size_t other = 0; other < voters_.size(); ++other) {
                if (other == index || voters_[other].voter == nullptr) continue;
                if (voters_[other].stopped_until > now_) voters_[other].queue.emplace_back(now_, output);
                else mail_.push_back({other, output});
            }
        }
        while (!mail_.empty()) {
            const auto [to, attitude] = mail_.back();
            mail_.pop_back();
            if (voters_[to].voter != nullptr && voters_[to].stopped_until <= voters_[to].started) hand_in(to, attitude, now_);
        }
    }

    Profile profile_;
    std::vector<Lane> lanes_;
    std::vector<Process> voters_;
    std::vector<Watch> watches_;
    std::vector<std::pair<std::size_t, VotedAttitude>> mail_;
    std::map<Identity, Quaternion> published_;
    std::string none_;
    std::int64_t now_ = 1000 * ms;
    Moment frame_;
    AxisMask faulty_ = 0;
};

}  // namespace quorient::voting::test
