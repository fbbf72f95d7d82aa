#include "field/start.hpp"

#include "field/order.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {

Start::Start(std::size_t instruments, double interval_s, const ClassFigures& figures)
    : count_(instruments),
      frames_needed_(FirstSecond::frames_needed(interval_s)),
      recent_rate_(std::min(1.0, interval_s / FirstSecond::recent_s)),
      figures_(figures)
{
    reset();
}

void Start::reset()
{
    first_.fill({});
    recent_.setZero();
    started_ = {};
    rested_ = {};
    bias_.setZero();
    outside_class_.reset();
}

void Start::forget(std::size_t m)
{
    first_[m] = {};
    started_.remove(m);
    rested_.remove(m);
    bias_.col(static_cast<Eigen::Index>(m)).setZero();
}

double Start::First::largest_deviation() const
{
    return std::max({of[0].deviation(), of[1].deviation(), of[2].deviation()});
}

void Start::take_bias_of_others(std::size_t m)
{
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    std::size_t n = 0;
    for (std::size_t j = 0; j < count_; ++j) {
        if (j == m || !started_.has(j)) continue;
        mean += bias(j);
        ++n;
    }
    if (n > 0) bias_.col(static_cast<Eigen::Index>(m)) = mean / static_cast<double>(n);
    rested_.remove(m);
}

InstrumentSet Start::add(const Frame& frame)
{
    InstrumentSet ended;
    for (std::size_t m = 0; m < count_; ++m) {
        if (!frame.present.has(m)) continue;
        const auto column = static_cast<Eigen::Index>(m);
        const Eigen::Vector3d rate = frame.rate.col(column);
        if (started_.has(m)) {
            recent_.col(column) += recent_rate_ * (rate - bias_.col(column) - recent_.col(column));
            continue;
        }
        First& first = first_[m];
        for (std::size_t c = 0; c < component_count; ++c) first.of[c].add(rate(static_cast<Eigen::Index>(c)));
        if (first.of[0].frames() >= frames_needed_) ended.add(m);
    }
    if (ended.empty()) return ended;

    outside_class_.reset();
    const bool rest = is_rest(ended);
    if (rest) check_class(ended);
    for (std::size_t m = 0; m < count_; ++m) {
        if (!ended.has(m)) continue;
        const auto column = static_cast<Eigen::Index>(m);
        if (rest) bias_.col(column) = first_[m].mean();
        recent_.col(column) = first_[m].mean() - bias_.col(column);
        rested_.set(m, rest);
    }
    started_ = started_ | ended;
    return ended;
}

double Start::level(std::size_t m, std::size_t component, InstrumentSet ended) const
{
    const auto c = static_cast<Eigen::Index>(component);
    return ended.has(m) ? first_[m].mean()(c) : recent_(c, static_cast<Eigen::Index>(m));
}

bool Start::is_rest(InstrumentSet ended) const
{
    for (std::size_t m = 0; m < count_; ++m)
        if (ended.has(m) && first_[m].largest_deviation() > FirstSecond::largest_deviation_at_rest) return false;
    for (std::size_t c = 0; c < component_count; ++c) {
        PerInstrument levels{};
        std::size_t n = 0;
        for (std::size_t m = 0; m < count_; ++m)
            if ((ended | started_).has(m)) levels[n++] = level(m, c, ended);
        if (std::abs(median(levels.data(), n)) > FirstSecond::largest_rate_at_rest) return false;
    }
    return true;
}

void Start::check_class(InstrumentSet ended)
{
    double largest = figures_.largest_bias_rad_s;
    for (std::size_t c = 0; c < component_count; ++c)
        for (std::size_t m = 0; m < count_; ++m) {
            if (!ended.has(m)) continue;
            PerInstrument others{};
            std::size_t n = 0;
            for (std::size_t j = 0; j < count_; ++j)
                if (j != m && (ended | started_).has(j)) others[n++] = level(j, c, ended);
            if (n < 2) continue;
            const auto [low, high] = std::minmax_element(others.begin(), others.begin() + n);
            const bool agree = *high - *low < figures_.largest_bias_rad_s / 2;
            const double difference = level(m, c, ended) - median(others.data(), n);
            if (!agree || std::abs(difference) <= largest) continue;
            largest = std::abs(difference);
            outside_class_ = {m, c, difference};
        }
}

}  // namespace quorient::fdi::field
