#pragma once

#include "quorient/messages/identity.hpp"
#include "quorient/messages/stamps.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/runtime/overload.hpp"
#include "quorient/runtime/pace.hpp"

#include <functional>
#include <optional>
#include <string_view>
#include <utility>

namespace quorient::runtime {

/// What a service leaves out while it is overloaded, and the events that say so.
///
/// Every sample is still received and worked with: that costs microseconds, so neither an increment nor an indication of a fault is lost.
/// What is left out is the output, whose sending costs a hundred times as much, and as much again in every receiver. All services keep the
/// same frames, those that Pace keeps, so that the lanes of a voter report of the same ones.
///
/// A service sheds where it does not keep up with its own input. It also does where the voted attitude comes late: then a voter does not keep
/// up, and most of what a voter has to do is to receive what the lanes send.
class Shedding {
public:
    /// @param outputs  in words, for the events
    Shedding(Node& node, std::string_view outputs) : node_(node), outputs_(outputs) {}

    /// Its input came: a frame, or what another service made of it. Frames that are not newer than all before them say nothing.
    void see(Identity identity, const Stamps& stamps, double interval_s, std::int64_t now_ns);

    /// The same of the voted attitude. Before any input it says nothing.
    void see_voted(Identity identity, const Stamps& stamps, std::int64_t now_ns);

    bool active() const { return input_.sheds() || voted_.sheds(); }

    /// Nothing is given out for this frame.
    bool leaves_out(Identity identity) const { return active() && !Pace::keeps(identity); }

    void count_skipped() { ++skipped_; }
    std::uint64_t skipped() const { return skipped_; }

private:
    struct Stream {
        SampleAge age;
        std::optional<Overload> overload;  ///< from the first frame on
        Identity newest;
        std::int64_t age_ns = 0;  ///< the newest one's

        bool sheds() const { return overload && overload->sheds(); }
        bool keeps_up() const { return !overload || overload->state() == Overload::State::keeping_up; }
        bool see(Identity identity, const Stamps& stamps, std::int64_t now_ns);
    };

    void report(const Stream& seen, std::int64_t now_ns);

    Node& node_;
    std::string_view outputs_;
    Stream input_;
    Stream voted_;
    Pace pace_of_voted_;
    bool reported_ = false;  ///< the begin, and the end not yet
    std::int64_t begin_ns_ = 0;
    std::uint64_t skipped_ = 0;
    std::uint64_t skipped_before_ = 0;  ///< the begin
};

/// Gives out a service's results: each one at once, or, while it sheds, the newest kept one of each round of the loop.
template <class Message>
class Outlet {
public:
    Outlet(Shedding& shedding, EventLoop& loop, std::function<void(const Message&)> send) : shedding_(shedding), send_(std::move(send))
    {
        loop.after_round([this] { flush(); });
    }

    /// @param news  it says something that the last one did not: it is never left out
    void give(const Message& message, bool news = false)
    {
        const bool left_out = !news && shedding_.leaves_out(identity_of(message));
        if (left_out) return shedding_.count_skipped();
        if (news || !shedding_.active()) {
            flush();
            return send_(message);
        }
        if (held_) shedding_.count_skipped();
        held_ = message;
    }

private:
    void flush()
    {
        if (!held_) return;
        send_(*held_);
        held_.reset();
    }

    Shedding& shedding_;
    std::function<void(const Message&)> send_;
    std::optional<Message> held_;
};

}  // namespace quorient::runtime
