#include "ballot.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/left_out.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

namespace quorient::voting {
namespace {

class Count {
public:
    Count(const BallotPaper& paper, const Agreement& agreement) : paper_(paper), agreement_(agreement)
    {
        for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
            if (paper.sample[lane] == nullptr) continue;
            ballot_.sampled |= lane_bit(lane);
            if (paper.sample[lane]->seeded != 0) ballot_.seeded |= lane_bit(lane);
        }
        eligible_ = most_trusted(ballot_.sampled & ~paper.blocked);
        ballot_.sigma_limit = median_sigma();
    }

    Ballot result()
    {
        if (eligible_ == 0) return ballot_;
        ballot_.isolated = winning_isolation();
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (has_lane(eligible_, lane) && is_in_group(*paper_.sample[lane])) group_ |= lane_bit(lane);
        }
        ballot_.several_groups = group_ != eligible_;
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (has_lane(group_, lane)) backers_[lane] = group_ & agreeing_with(lane);
        }
        const LaneIndex primary = choose();
        ballot_.primary = primary;
        ballot_.left_out = left_out_mask(*paper_.sample[primary]);
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (!has_lane(ballot_.sampled, lane)) continue;
            count_vote(ballot_, lane, *paper_.sample[lane], *paper_.sample[primary], !has_lane(paper_.blocked, lane), agreement_);
        }
        ballot_.backed = is_majority(ballot_.vouching);
        ballot_.spread_rad = spread(ballot_.vouching);
        return ballot_;
    }

private:
    LaneMask most_trusted(LaneMask lanes) const
    {
        LaneMask best = 0;
        int least = 3;
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (!has_lane(lanes, lane)) continue;
            const int level = distrust(*paper_.sample[lane]);
            if (level < least) {
                least = level;
                best = 0;
            }
            if (level == least) best |= lane_bit(lane);
        }
        return best;
    }

    double median_sigma() const
    {
        std::array<double, max_lanes> sigma{};
        std::size_t count = 0;
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (has_lane(eligible_, lane)) sigma[count++] = paper_.sample[lane]->angle_sigma_rad;
        }
        if (count == 0) return 0;
        const auto middle = sigma.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);  // the lower one of two
        std::nth_element(sigma.begin(), middle, sigma.begin() + static_cast<std::ptrdiff_t>(count));
        return *middle;
    }

    AxisMask winning_isolation() const
    {
        AxisMask isolated_by_any = 0;
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (has_lane(eligible_, lane)) isolated_by_any |= paper_.sample[lane]->isolated_mask;
        }
        using Score = std::tuple<int, int, int, int>;  // less is better
        std::optional<Score> best;
        AxisMask winner = 0;
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (!has_lane(eligible_, lane)) continue;
            const AxisMask isolated = paper_.sample[lane]->isolated_mask;
            const Score score{std::popcount(paper_.corroborated & isolated_by_any & ~isolated),
                              std::popcount(isolated & ~paper_.corroborated), lane == paper_.wanted ? 0 : 1,
                              lane == paper_.current ? 0 : 1};
            if (best && !(score < *best)) continue;
            best = score;
            winner = isolated;
        }
        return winner;
    }

    /// It isolates what the group does, or leaves some of that out provisionally.
    bool is_in_group(const AttitudeState& sample) const
    {
        return (sample.isolated_mask & ~ballot_.isolated) == 0 && (ballot_.isolated & ~left_out_mask(sample)) == 0;
    }

    LaneMask agreeing_with(LaneIndex lane) const
    {
        LaneMask lanes = lane_bit(lane);
        const AttitudeState& own = *paper_.sample[lane];
        for (LaneIndex other = 0; other < paper_.lanes; ++other) {
            if (other == lane || !has_lane(ballot_.sampled, other)) continue;
            if (agreement_.agree(lane, own, other, *paper_.sample[other], ballot_.sigma_limit)) lanes |= lane_bit(other);
        }
        return lanes;
    }

    bool is_majority(LaneMask lanes) const { return voting::is_majority(lanes, ballot_.seeded, paper_.unseeded_remain, paper_.majority); }

    bool is_contradicted(LaneIndex lane) const
    {
        if (is_majority(backers_[lane])) return false;
        for (LaneIndex other = 0; other < paper_.lanes; ++other) {
            const bool apart = has_lane(group_, other) && !has_lane(backers_[lane], other) && is_majority(backers_[other]);
            if (apart && !may_be_late(other, lane)) return true;
        }
        return false;
    }

    /// `lane` leaves out a reported axis that `other` still uses: `other` may find the fault later. It must not leave out another reported
    /// axis that `lane` uses.
    bool may_be_late(LaneIndex other, LaneIndex lane) const
    {
        const AxisMask others = left_out_mask(*paper_.sample[other]);
        const AxisMask own = left_out_mask(*paper_.sample[lane]);
        return paper_.settling && (own & ~others & paper_.corroborated) != 0 && (others & ~own & paper_.corroborated) == 0;
    }

    LaneIndex choose() const
    {
        const bool late_majority_possible = paper_.settling && ballot_.isolated != 0 && (ballot_.isolated & ~paper_.corroborated) == 0;
        for (const LaneIndex lane : {paper_.wanted, paper_.current}) {
            if (has_lane(group_, lane) && (late_majority_possible || !is_contradicted(lane))) return lane;
        }
        using Merit = std::tuple<bool, bool, bool, int>;
        std::optional<Merit> best;
        LaneIndex chosen = 0;
        for (LaneIndex lane = 0; lane < paper_.lanes; ++lane) {
            if (!has_lane(group_, lane)) continue;
            const Merit merit{is_majority(backers_[lane]), !is_contradicted(lane), paper_.sample[lane]->seeded == 0,
                              std::popcount(backers_[lane])};
            if (best && merit <= *best) continue;
            best = merit;
            chosen = lane;
        }
        return chosen;
    }

    double spread(LaneMask lanes) const
    {
        double largest = 0;
        for (LaneIndex a = 0; a < paper_.lanes; ++a) {
            for (LaneIndex b = a + 1; b < paper_.lanes; ++b) {
                if (!has_lane(lanes, a) || !has_lane(lanes, b)) continue;
                largest = std::max(largest, angle_between(paper_.sample[a]->attitude, paper_.sample[b]->attitude));
            }
        }
        return largest;
    }

    const BallotPaper& paper_;
    const Agreement& agreement_;
    LaneMask eligible_ = 0;
    LaneMask group_ = 0;
    std::array<LaneMask, max_lanes> backers_{};
    Ballot ballot_;
};

}  // namespace

bool is_countable(const AttitudeState& sample)
{
    if (sample.used_mask == 0) return false;
    switch (mode_of(sample)) {
        case AttitudeMode::normal:
        case AttitudeMode::ambiguous:
        case AttitudeMode::untrusted:
        case AttitudeMode::lost:
            return true;
        default:
            return false;
    }
}

int distrust(const AttitudeState& sample)
{
    switch (mode_of(sample)) {
        case AttitudeMode::untrusted:
            return 1;
        case AttitudeMode::lost:
            return 2;
        default:
            return 0;
    }
}

bool is_majority(LaneMask lanes, LaneMask seeded, bool unseeded_remain, std::size_t majority)
{
    return static_cast<std::size_t>(std::popcount(lanes)) >= majority && (!unseeded_remain || (lanes & ~seeded) != 0);
}

void count_vote(Ballot& ballot, LaneIndex lane, const AttitudeState& sample, const AttitudeState& primary, bool may_vouch,
                const Agreement& agreement)
{
    ballot.sampled |= lane_bit(lane);
    if (sample.seeded != 0) ballot.seeded |= lane_bit(lane);
    if (lane != *ballot.primary && !agreement.agree(lane, sample, *ballot.primary, primary, ballot.sigma_limit)) return;
    ballot.agreeing |= lane_bit(lane);
    if (may_vouch && distrust(sample) == distrust(primary)) ballot.vouching |= lane_bit(lane);
}

Ballot count(const BallotPaper& paper, const Agreement& agreement)
{
    return Count(paper, agreement).result();
}

}  // namespace quorient::voting
