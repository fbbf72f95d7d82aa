#include "history.hpp"
#include "quorient/messages/meaning.hpp"

namespace quorient::attitude {

Standing standing_of(const VotedAttitude& voted)
{
    Standing standing;
    standing.attitude = renormalised(from_array(voted.attitude));
    standing.variance = voted.angle_sigma_rad * voted.angle_sigma_rad;
    if (mode_of(voted) == AttitudeMode::untrusted) standing.alignment = Alignment::untrusted;
    return standing;
}

void Record::combine(const BodyIncrement::Solution& solution)
{
    body.setZero();
    for (std::size_t axis = 0; axis < max_axes; ++axis) body += solution.gain.col(static_cast<Eigen::Index>(axis)) * increment[axis];
    variance = solution.variance;
    quantum_variance = solution.quantum_variance;
}

void History::drop_oldest()
{
    assert(!empty());
    start_ = oldest().standing;
    opinion_at_start_ = oldest().opinion;
    cut_ = true;
    head_ = (head_ + 1) % slots_.size();
    --size_;
}

void History::restart(const Standing& start, const Opinion& opinion)
{
    size_ = 0;
    start_ = start;
    opinion_at_start_ = opinion;
    cut_ = false;
}

void History::begin_at(const Standing& start)
{
    start_ = start;
    cut_ = false;
    if (!empty()) (*this)[0].standing.count = 0;
}

std::size_t History::find(std::uint64_t sequence) const
{
    std::size_t low = 0;
    std::size_t high = size_;
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if ((*this)[middle].last_sequence < sequence) low = middle + 1;
        else high = middle;
    }
    return low < size_ && (*this)[low].first_sequence <= sequence ? low : size_;
}

bool History::place(const Opinion& opinion, std::size_t index)
{
    Record& record = (*this)[index];
    if (record.own_opinion) {
        const Opinion& present = record.opinion;
        if (present.sequence > opinion.sequence || (present.sequence == opinion.sequence && !opinion.precedes(present))) return false;
    }
    record.opinion = opinion;
    record.own_opinion = true;
    return true;
}

std::size_t History::carry_opinions(std::size_t index)
{
    for (; index < size_; ++index) {
        Record& record = (*this)[index];
        const Opinion& before = opinion_before(index);
        if (record.own_opinion) record.opinion.follow(before.known);
        else record.opinion = before;
        const bool next_is_apart = index + 1 < size_ && (*this)[index + 1].own_opinion && (*this)[index + 1].opinion.clears();
        if (next_is_apart) return index + 1;
    }
    return index;
}

}  // namespace quorient::attitude
