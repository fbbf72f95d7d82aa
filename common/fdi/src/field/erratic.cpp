#include "field/erratic.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {
namespace {

constexpr double watched_s = 1.0;
constexpr std::size_t least_frames = 40;
constexpr double share_of_frames = 0.35;
constexpr double times_any_other = 2;

std::size_t frames_of(double interval_s)
{
    return std::max(least_frames, static_cast<std::size_t>(std::lround(watched_s / interval_s)));
}

}  // namespace

Erratic::Erratic(std::size_t instruments, double interval_s) : count_(instruments), frames_(frames_of(interval_s)) {}

void Erratic::reset()
{
    std::fill(frames_.begin(), frames_.end(), std::array<InstrumentSet, component_count>{});
    for (auto& component : off_) component.fill(0);
}

void Erratic::add(const std::array<InstrumentSet, component_count>& off)
{
    auto& oldest = frames_[next_];
    for (std::size_t c = 0; c < component_count; ++c)
        for (std::size_t m = 0; m < count_; ++m) {
            if (off[c].has(m)) ++off_[c][m];
            if (oldest[c].has(m)) --off_[c][m];
        }
    oldest = off;
    next_ = (next_ + 1) % frames_.size();
}

double Erratic::share(std::size_t component, std::size_t m) const
{
    return static_cast<double>(off_[component][m]) / static_cast<double>(frames_.size());
}

std::optional<Erratic::Finding> Erratic::finding(InstrumentSet compared) const
{
    for (std::size_t m = 0; m < count_; ++m) {
        if (!compared.has(m)) continue;
        for (std::size_t c = 0; c < component_count; ++c) {
            const double mine = share(c, m);
            if (mine <= share_of_frames) continue;
            double others = 0;
            for (std::size_t j = 0; j < count_; ++j)
                if (j != m && compared.has(j)) others = std::max(others, share(c, j));
            if (mine > times_any_other * others) return Finding{m, c, mine};
        }
    }
    return std::nullopt;
}

}  // namespace quorient::fdi::field
