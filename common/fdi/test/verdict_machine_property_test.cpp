// Rule-based random tests: random sequences of everything that can happen to a verdict machine, its promises checked after each event
// against the events themselves.

#include "verdict/verdict_machine.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <deque>
#include <random>
#include <vector>

namespace quorient::fdi {
namespace {

constexpr std::size_t axis_count = 6;
constexpr int sequences = 120'000;
constexpr int events_per_sequence = 24;

struct Frame {
    Assessment assessment;
    AxisMask broken = 0;
};

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    unsigned below(unsigned n) { return static_cast<unsigned>(engine_() % n); }
    bool one_in(unsigned n) { return below(n) == 0; }
    AxisMask small_set() { return one_in(3) ? axis_bit(below(3)) | axis_bit(below(3)) : axis_bit(below(3)); }
    std::mt19937_64& engine() { return engine_; }

    Frame frame()
    {
        constexpr std::array outcomes{Outcome::healthy, Outcome::healthy, Outcome::isolated, Outcome::isolated,  Outcome::isolated,
                                      Outcome::suspect, Outcome::refused, Outcome::blind,    Outcome::ambiguous, Outcome::warming_up};
        Frame frame;
        frame.assessment.outcome = outcomes[below(outcomes.size())];
        const bool can_name = frame.assessment.outcome == Outcome::isolated || frame.assessment.outcome == Outcome::suspect;
        if (can_name) frame.assessment.isolated = small_set();
        const bool can_list = can_name || frame.assessment.outcome == Outcome::ambiguous;
        for (unsigned i = can_list ? below(3) : 0; i > 0; --i) frame.assessment.add_candidate(small_set());
        if (one_in(6)) frame.broken = axis_bit(below(axis_count));
        if (one_in(4)) {
            frame.assessment.provisional = small_set() << below(4);
            frame.assessment.provisional_from = one_in(4) ? never : below(30);
        }
        frame.assessment.saturated = one_in(20);
        return frame;
    }

private:
    std::mt19937_64 engine_;
};

/// What happened, and what the promises allow after it.
struct History {
    std::deque<Frame> named;   ///< informative frames since the last isolation, readmission or epoch, newest last
    std::deque<Frame> recent;  ///< frames of this epoch, newest last
    AxisMask isolated_before = 0;

    /// An isolated axis starts anew when it is readmitted: what was held against it before no longer counts.
    void settle(AxisMask isolated)
    {
        named.clear();
        for (Frame& frame : recent) frame.broken &= ~isolated;
    }
};

AxisMask union_of_explanations(const Frame& frame)
{
    // A mere hint counts as an explanation only where the method lists none.
    const bool hint = frame.assessment.outcome == Outcome::suspect && frame.assessment.candidate_count > 0;
    AxisMask all = frame.broken | frame.assessment.provisional | (hint ? 0 : frame.assessment.isolated);
    for (unsigned i = 0; i < frame.assessment.candidate_count; ++i) all |= frame.assessment.candidate[i];
    return all;
}

bool names_without_rival(const Frame& frame, AxisMask set, AxisMask isolated_before)
{
    const Assessment& assessment = frame.assessment;
    if (assessment.outcome != Outcome::isolated || (assessment.isolated & ~isolated_before) != set) return false;
    for (unsigned i = 0; i < assessment.candidate_count; ++i) {
        const AxisMask rival = assessment.candidate[i] & ~isolated_before;
        if (rival != 0 && rival != set && std::popcount(rival) <= std::popcount(set)) return false;
    }
    return true;
}

/// The axes that the stated rules permit to be isolated at the newest frame, each with its own justification.
AxisMask justified(const History& history, const VerdictSettings& settings)
{
    AxisMask axes = 0;
    const AxisMask named = history.recent.back().assessment.isolated & ~history.isolated_before;
    const bool newest_names = names_without_rival(history.recent.back(), named, history.isolated_before);
    const auto window = std::min<std::size_t>(history.named.size(), settings.confirm_window);
    const auto agreeing = std::count_if(history.named.end() - static_cast<std::ptrdiff_t>(window), history.named.end(),
                                        [&](const Frame& f) { return names_without_rival(f, named, history.isolated_before); });
    if (newest_names && agreeing >= settings.confirm_required) axes |= named;

    const auto frames = std::min<std::size_t>(history.recent.size(), settings.confirm_window);
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
        const auto broken = std::count_if(history.recent.end() - static_cast<std::ptrdiff_t>(frames), history.recent.end(),
                                          [&](const Frame& f) { return has_axis(f.broken, axis); });
        if (has_axis(history.recent.back().broken, axis) && broken >= settings.confirm_required) axes |= axis_bit(axis);
    }
    return axes;
}

AxisMask explained_recently(const History& history, const VerdictSettings& settings)
{
    AxisMask axes = 0;
    for (const auto* frames : {&history.named, &history.recent}) {
        const auto window = std::min<std::size_t>(frames->size(), settings.confirm_window);
        for (auto frame = frames->end() - static_cast<std::ptrdiff_t>(window); frame != frames->end(); ++frame)
            axes |= union_of_explanations(*frame);
    }
    return axes;
}

/// What the method wants out is out, and nothing else, as long as three axes are left.
void expect_left_out(const FaultVerdict& verdict, const Frame& frame, bool warm)
{
    const AxisMask asked = warm ? (frame.assessment.provisional | frame.broken) & all_axes(axis_count) & ~verdict.isolated_mask : 0;
    const bool enough = std::popcount(all_axes(axis_count) & ~verdict.isolated_mask & ~asked) >= 3;
    ASSERT_EQ(provisional_mask(verdict), enough ? asked : 0U);
    const auto state = state_of(verdict);
    ASSERT_TRUE(provisional_mask(verdict) == 0 || state == VerdictState::provisional || state == VerdictState::saturated);
}

void expect_complete(const FaultVerdict& verdict)
{
    AxisMask excluded = 0;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (verdict.excluded_from[axis] == never) continue;
        excluded |= axis_bit(axis);
        ASSERT_LE(verdict.excluded_from[axis], verdict.sequence);
    }
    ASSERT_EQ(excluded & verdict.isolated_mask, verdict.isolated_mask);
    ASSERT_EQ(verdict.working_mask, all_axes(axis_count) & ~excluded);
    ASSERT_EQ(verdict.suspect_mask & verdict.isolated_mask, 0U);
    const auto state = state_of(verdict);
    const bool troubled = (verdict.isolated_mask | verdict.suspect_mask | verdict.candidate_count) != 0;
    ASSERT_FALSE(state == VerdictState::healthy && troubled);
    ASSERT_FALSE(state == VerdictState::isolated && verdict.isolated_mask == 0);
    ASSERT_FALSE(state == VerdictState::ambiguous && verdict.candidate_count == 0);
}

void expect_only_explained_blame(const FaultVerdict& verdict, AxisMask explained)
{
    ASSERT_EQ(verdict.suspect_mask & ~explained, 0U);
    for (unsigned i = 0; i < verdict.candidate_count; ++i) ASSERT_EQ(verdict.candidate_set[i] & ~explained, 0U);
}

bool same(const FaultVerdict& a, const FaultVerdict& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// A consumer that sees every verdict, some twice, in any order, holds the newest one's state.
void expect_consumer_agrees(std::vector<FaultVerdict> verdicts, Random& random)
{
    const FaultVerdict last = verdicts.back();
    for (int i = 0; i < 4; ++i) verdicts.push_back(verdicts[random.below(static_cast<unsigned>(verdicts.size()))]);
    std::shuffle(verdicts.begin(), verdicts.end(), random.engine());
    FaultVerdict held = verdicts.front();
    for (const FaultVerdict& verdict : verdicts)
        if (identity_of(verdict) > identity_of(held)) held = verdict;
    ASSERT_TRUE(same(held, last));
}

struct Play {
    VerdictSettings settings;
    VerdictMachine machine;
    Random& random;
    Identity next{1, 0};
    History history{};
    std::vector<FaultVerdict> published{};

    void frame()
    {
        if (random.one_in(10)) next.sequence += random.below(20);
        Frame frame = random.frame();
        frame.broken &= ~machine.isolated();
        history.isolated_before = machine.isolated();
        history.recent.push_back(frame);
        if (frame.assessment.outcome != Outcome::warming_up) history.named.push_back(frame);
        const FaultVerdict& verdict = machine.update(next, frame.assessment, frame.broken);
        const AxisMask newly = verdict.isolated_mask & ~history.isolated_before;
        ASSERT_EQ(newly & ~justified(history, settings), 0U) << "isolated without the evidence it asks for";
        ASSERT_EQ(history.isolated_before & ~verdict.isolated_mask, 0U) << "readmitted by a frame";
        const bool warm = history.recent.size() > settings.warm_up_frames;
        ASSERT_TRUE(!warm || (justified(history, settings) & ~verdict.isolated_mask) == 0) << "did not isolate";
        expect_left_out(verdict, frame, warm);
        expect_complete(verdict);
        expect_only_explained_blame(verdict, explained_recently(history, settings));
        if (newly != 0) history.settle(newly);
        published.push_back(verdict);
        ++next.sequence;
    }

    void stale_frame()
    {
        if (published.empty()) return;
        const FaultVerdict before = machine.verdict();
        const FaultVerdict& old = published[random.below(static_cast<unsigned>(published.size()))];
        machine.update(identity_of(old), random.frame().assessment, 0b111);
        ASSERT_TRUE(same(before, machine.verdict())) << "a frame that is not newer changed the verdict";
    }

    void new_epoch()
    {
        next = {next.epoch + 1, 0};
        history.named.clear();
        history.recent.clear();
        const AxisMask before = machine.isolated();
        frame();
        if (::testing::Test::HasFatalFailure()) return;
        for (std::size_t axis = 0; axis < axis_count; ++axis)
            ASSERT_TRUE(!has_axis(before, axis) || machine.verdict().excluded_from[axis] == 0);
    }

    void readmit()
    {
        const AxisMask asked = random.below(64);
        const AxisMask before = machine.isolated();
        ASSERT_EQ(machine.readmit(asked), asked & before);
        ASSERT_EQ(machine.isolated(), before & ~asked);
        if ((asked & before) != 0) history.settle(0);
    }

    void adopt()
    {
        if (published.empty()) return;
        auto excluded_from = Exclusions{};
        const std::size_t axis = random.below(axis_count);
        excluded_from[axis] = random.below(static_cast<unsigned>(next.sequence) + 1);
        const std::uint64_t earliest = std::min(excluded_from[axis], machine.verdict().excluded_from[axis]);
        machine.adopt(excluded_from);
        ASSERT_EQ(machine.verdict().excluded_from[axis], earliest);
        ASSERT_TRUE(has_axis(machine.isolated(), axis));
        history.settle(axis_bit(axis));
    }

    void event()
    {
        switch (random.below(24)) {
            case 0:
                return stale_frame();
            case 1:
                return readmit();
            case 2:
                return random.one_in(3) ? adopt() : frame();
            case 3:
                return random.one_in(3) ? new_epoch() : frame();
            default:
                return frame();
        }
    }
};

TEST(VerdictMachineProperties, hold_after_every_event_of_random_sequences)
{
    constexpr std::uint64_t seed = 20'251'122;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::array<std::uint64_t, 9> seen{};
    for (int i = 0; i < sequences; ++i) {
        SCOPED_TRACE("sequence " + std::to_string(i));
        const unsigned window = 1 + random.below(5);
        const VerdictSettings settings{.confirm_required = 1 + random.below(window),
                                       .confirm_window = window,
                                       .warm_up_frames = random.below(4),
                                       .onset_guard_frames = random.below(3)};
        Play play{.settings = settings, .machine = VerdictMachine::make(settings, axis_count).value(), .random = random};
        for (int event = 0; event < events_per_sequence; ++event) {
            play.event();
            if (HasFatalFailure()) return;
        }
        for (const FaultVerdict& verdict : play.published) ++seen[verdict.state];
        if (!play.published.empty()) expect_consumer_agrees(play.published, random);
        if (HasFatalFailure()) return;
    }
    for (std::size_t state = 1; state < seen.size(); ++state) EXPECT_GT(seen[state], 1000U) << "state " << state << " is hardly ever tried";
}

}  // namespace
}  // namespace quorient::fdi
