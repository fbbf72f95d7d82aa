// How the clocks of several instruments stand to each other, by the rate of turn that they show: its size is the same in every mounting.

#include "quorient/recording/survey.hpp"

#include "quorient/messages/time.hpp"
#include "turn_profile.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace quorient::recording {
namespace {

constexpr std::ptrdiff_t steps_around = 15;  // on either side of a top
constexpr double least_curvature = 1e-5;    // correlation per step squared: motion below 0.05 Hz fixes no time
constexpr double least_unlike = 1e-8;       // what rounding leaves of 1 - correlation squared
constexpr double largest_lag_error_s = 0.005;
constexpr double tied_correlation = 0.9;    // from it on, the motion ties two clocks
constexpr double same_log_lag_s = 0.15;     // that filters and buses of one vehicle differ by
constexpr double same_epoch_lag_s = 1.0;
constexpr double other_epoch_lag_s = 3.0;   // logs that were switched on by hand
constexpr double least_motion_rad_s = 0.02; // standard deviation of the rate of turn in a stretch that fixes a time
constexpr std::size_t fewest_for_slope = 5;
constexpr double least_gain = 0.9;          // placing samples must reduce the disagreement to this share

using Rate = std::array<double, 3>;

/// Mean rate of an instrument while another one of the same log was there too. Both turned alike meanwhile, so the sizes of what is left of
/// the rates have the biases no more. These would move the tops: beside a slow motion a bias of 1 deg/s looks like 10 ms.
Rate common_mean(const SurveyedInstrument& instrument, const SurveyedInstrument& other)
{
    Rate sum{};
    double count = 0;
    for (std::size_t i = 0; i < std::min(instrument.windows.size(), other.windows.size()); ++i) {
        const KeptWindow& own = instrument.windows[i];
        const KeptWindow& theirs = other.windows[i];
        if (own.empty() || theirs.empty()) continue;
        for (const KeptSample& sample : own) {
            const auto& rate = sample.rate_rad_s;
            if (sample.time_ns < theirs.front().time_ns || sample.time_ns > theirs.back().time_ns ||
                !std::isfinite(rate[0] + rate[1] + rate[2]))
                continue;
            for (std::size_t part = 0; part < 3; ++part) sum[part] += static_cast<double>(rate[part]);
            ++count;
        }
    }
    for (double& part : sum) part = count > 0 ? part / count : 0;
    return sum;
}

/// Angle turned through, beyond a mean rate, up to a grid of times since the window's begin; NaN where the instrument has no sample.
Profile angle_profile(const KeptWindow& window, const std::vector<std::int64_t>& time_ns, std::int64_t begin_ns, const Rate& mean)
{
    const auto count = static_cast<std::size_t>(std::lround(window_s / grid_s));
    Profile angle(count + 1, std::nan(""));
    double turned = 0;
    for (std::size_t i = 1; i < window.size(); ++i) {
        const double from_s = static_cast<double>(time_ns[i - 1] - begin_ns) * 1e-9;
        const double to_s = static_cast<double>(time_ns[i] - begin_ns) * 1e-9;
        const auto& rate = window[i].rate_rad_s;
        const double speed = std::hypot(static_cast<double>(rate[0]) - mean[0], static_cast<double>(rate[1]) - mean[1],
                                        static_cast<double>(rate[2]) - mean[2]);
        if (!(to_s > from_s) || to_s - from_s > 0.2 || !std::isfinite(speed)) continue;
        const double last = std::min(static_cast<double>(count), std::floor(to_s / grid_s));
        for (double point = std::ceil(std::max(0.0, from_s) / grid_s); point <= last; ++point)
            angle[static_cast<std::size_t>(point)] = turned + speed * (point * grid_s - from_s);
        turned += speed * (to_s - from_s);
    }
    return angle;
}

/// Rate of turn at the same times.
Profile rate_profile(const Profile& angle, std::size_t average)
{
    Profile rate(angle.size(), std::nan(""));
    for (std::size_t i = average; i + average < angle.size(); ++i)
        rate[i] = (angle[i + average] - angle[i - average]) / (2 * static_cast<double>(average) * grid_s);
    return rate;
}

/// Sums for the correlation of two profiles at one lag.
struct Sums {
    double count = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(const Profile& first, const Profile& second, std::ptrdiff_t lag)
    {
        const auto size = static_cast<std::ptrdiff_t>(std::min(first.size(), second.size()));
        for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -lag); i < std::min(size, size - lag); ++i) {
            const double x = first[static_cast<std::size_t>(i)];
            const double y = second[static_cast<std::size_t>(i + lag)];
            if (!std::isfinite(x) || !std::isfinite(y)) continue;
            ++count;
            a += x;
            b += y;
            aa += x * x;
            bb += y * y;
            ab += x * y;
        }
    }

    double correlation() const
    {
        if (count < 20) return -1;
        const double scale = (aa - a * a / count) * (bb - b * b / count);
        return scale > 0 ? (ab - a * b / count) / std::sqrt(scale) : -1;
    }

    /// Standard deviation of the first profile.
    double motion() const { return count > 1 ? std::sqrt(std::max(0.0, aa / count - a * a / count / count)) : 0; }
};

/// Where the correlations have their top, in steps from the middle one.
struct Top {
    double lag = 0;
    double correlation = -1;
    double curvature = 0;  ///< per step squared, over the steps around; below 0 at a top
    bool inside = false;   ///< not at either end
};

Top top_of(const std::vector<double>& correlations)
{
    const auto top = std::max_element(correlations.begin(), correlations.end());
    Top found;
    found.lag = static_cast<double>(top - correlations.begin()) - static_cast<double>(correlations.size() / 2);
    found.correlation = *top;
    found.inside = top != correlations.begin() && top + 1 != correlations.end();
    if (!found.inside) return found;
    const double bend = *(top - 1) - 2 * *top + *(top + 1);
    if (bend < 0) found.lag += 0.5 * (*(top - 1) - *(top + 1)) / bend;
    const auto reach = std::min({steps_around, top - correlations.begin(), correlations.end() - 1 - top});
    found.curvature = (*(top - reach) - 2 * *top + *(top + reach)) / static_cast<double>(reach * reach);
    return found;
}

/// Profiles of one instrument, by number of the stretch; empty where nothing was kept.
struct Profiles {
    std::vector<Profile> smooth;
    std::vector<Profile> sharp;  ///< without averaging: shows how well samples are placed
};

std::vector<std::int64_t> stamps_of(const KeptWindow& window)
{
    std::vector<std::int64_t> stamps;
    for (const KeptSample& sample : window) stamps.push_back(sample.time_ns);
    return stamps;
}

/// The stamps of a stretch placed on the instrument's own clock.
std::vector<std::int64_t> placed_on_own_clock(const KeptWindow& window, double period_s, std::vector<double>* late_s, std::uint64_t* lost)
{
    ArrivalClock clock(period_s);
    std::vector<std::int64_t> placed;
    for (const KeptSample& sample : window) clock.add(sample.time_ns);
    clock.finish();
    while (const auto placement = clock.next()) {
        placed.push_back(placement->time_ns);
        if (late_s != nullptr) late_s->push_back(placement->late_s);
        if (lost != nullptr) *lost += placement->lost;
    }
    return placed;
}

class Tie {
public:
    explicit Tie(Survey& survey) : survey_(survey) {}

    tl::expected<void, std::string> all()
    {
        const bool own_clocks = choose_placement();
        for (const std::size_t i : survey_.compared) {
            SurveyedInstrument& instrument = survey_.instruments[i];
            if (own_clocks) note_own_clock(instrument);
        }
        SurveyedInstrument& first = survey_.instruments[survey_.compared.front()];
        const Profiles reference = profiles(first, own_clocks, {});
        first.clock.tied = true;
        first.clock.correlation = 1;
        for (const std::size_t i : survey_.compared) {
            SurveyedInstrument& instrument = survey_.instruments[i];
            if (&instrument == &first) continue;
            const bool same_log = instrument.log == first.log;
            const Profiles centred = same_log ? profiles(first, own_clocks, common_mean(first, instrument)) : Profiles{};
            const Profiles own = profiles(instrument, own_clocks, same_log ? common_mean(instrument, first) : Rate{});
            if (auto tied = tie(same_log ? centred : reference, own, instrument); !tied) return tied;
        }
        return {};
    }

private:
    std::int64_t origin_ns(const SurveyedInstrument& instrument) const
    {
        return survey_.one_epoch ? survey_.logs.front().first_ns : survey_.logs[instrument.log].first_ns;
    }

    /// Windows are numbered from the first sample of their own log; profiles from the common origin.
    Profiles profiles(const SurveyedInstrument& instrument, bool own_clock, const Rate& mean) const
    {
        Profiles made;
        const bool placed = own_clock && instrument.arrival_period_s;
        const std::int64_t length_ns = nanoseconds(window_s);
        std::int64_t begin_ns = origin_ns(instrument);
        KeptWindow part;
        std::vector<std::int64_t> part_times;
        const auto end_part = [&] {
            const Profile angle = part.empty() ? Profile{} : angle_profile(part, part_times, begin_ns, mean);
            made.smooth.push_back(rate_profile(angle, half_window));
            made.sharp.push_back(rate_profile(angle, 1));
            part.clear();
            part_times.clear();
            begin_ns += length_ns;
        };
        for (const KeptWindow& window : instrument.windows) {
            if (window.empty()) continue;
            const auto at = placed ? placed_on_own_clock(window, *instrument.arrival_period_s, nullptr, nullptr) : stamps_of(window);
            for (std::size_t i = 0; i < window.size(); ++i) {
                while (at[i] - begin_ns >= length_ns) end_part();
                part.push_back(window[i]);
                part_times.push_back(at[i]);
            }
        }
        if (!part.empty()) end_part();
        return made;
    }

    /// Whether the instruments agree better with their samples on their own clocks than with their stamps as they are.
    bool choose_placement()
    {
        const auto late = [&](std::size_t i) {
            const SurveyedInstrument& instrument = survey_.instruments[i];
            return instrument.instrument.stamps == StampKind::arrival && instrument.arrival_period_s.has_value();
        };
        if (survey_.compared.size() < 2 || !std::all_of(survey_.compared.begin(), survey_.compared.end(), late) || rows_in_common()) return false;
        return disagreement(true) < least_gain * disagreement(false);
    }

    /// Instruments that stand in the same rows share their stamps: none is late against another.
    bool rows_in_common() const
    {
        const SurveyedInstrument& first = survey_.instruments[survey_.compared.front()];
        for (const std::size_t i : survey_.compared) {
            const SurveyedInstrument& other = survey_.instruments[i];
            if (other.log != first.log || other.windows.empty() || first.windows.empty()) return false;
            std::size_t equal = 0;
            std::size_t at = 0;
            for (const KeptSample& sample : other.windows.front()) {
                while (at < first.windows.front().size() && first.windows.front()[at].time_ns < sample.time_ns) ++at;
                equal += at < first.windows.front().size() && first.windows.front()[at].time_ns == sample.time_ns ? 1 : 0;
            }
            if (2 * equal < other.windows.front().size()) return false;
        }
        return true;
    }

    /// Sum over all instruments of 1 - correlation with the first one, without averaging, at the best lag.
    double disagreement(bool own_clocks) const
    {
        const Profiles reference = profiles(survey_.instruments[survey_.compared.front()], own_clocks, {});
        double sum = 0;
        for (std::size_t i = 1; i < survey_.compared.size(); ++i) {
            const SurveyedInstrument& instrument = survey_.instruments[survey_.compared[i]];
            const Profiles other = profiles(instrument, own_clocks, {});
            sum += 1 - top_of(correlations(reference.sharp, other.sharp, 0, longest_lag(instrument))).correlation;
        }
        return sum;
    }

    void note_own_clock(SurveyedInstrument& instrument) const
    {
        ClockFigures& clock = instrument.clock;
        clock.own_clock = true;
        clock.own_period_s = *instrument.arrival_period_s;
        std::vector<double> late_s;
        for (const KeptWindow& window : instrument.windows) placed_on_own_clock(window, clock.own_period_s, &late_s, &clock.lost);
        if (late_s.empty()) return;
        std::sort(late_s.begin(), late_s.end());
        clock.late_median_s = late_s[late_s.size() / 2];
        clock.late_99_s = late_s[late_s.size() * 99 / 100];
        clock.late_most_s = late_s.back();
    }

    std::ptrdiff_t longest_lag(const SurveyedInstrument& instrument) const
    {
        const bool same_log = instrument.log == survey_.instruments[survey_.compared.front()].log;
        const double lag_s = same_log ? same_log_lag_s : survey_.one_epoch ? same_epoch_lag_s : other_epoch_lag_s;
        return std::lround(lag_s / grid_s);
    }

    static std::vector<double> correlations(const std::vector<Profile>& a, const std::vector<Profile>& b, std::ptrdiff_t middle, std::ptrdiff_t most)
    {
        std::vector<double> values;
        for (std::ptrdiff_t lag = middle - most; lag <= middle + most; ++lag) {
            Sums sums;
            for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
                if (!a[i].empty() && !b[i].empty()) sums.add(a[i], b[i], lag);
            values.push_back(sums.correlation());
        }
        return values;
    }

    /// Standard deviation of where the top lies.
    static double lag_error_s(const Profiles& reference, const Profiles& other, const Top& top)
    {
        Sums sums;
        for (std::size_t i = 0; i < std::min(reference.smooth.size(), other.smooth.size()); ++i)
            if (!reference.smooth[i].empty() && !other.smooth[i].empty()) sums.add(reference.smooth[i], other.smooth[i], std::lround(top.lag));
        const double independent = sums.count / (2.0 * half_window);
        const double unlike = std::max(least_unlike, 1 - top.correlation * top.correlation);
        return top.curvature < 0 ? grid_s * std::sqrt(unlike / (-top.curvature * independent)) : std::numeric_limits<double>::infinity();
    }

    tl::expected<void, std::string> tie(const Profiles& reference, const Profiles& other, SurveyedInstrument& instrument) const
    {
        ClockFigures& clock = instrument.clock;
        const Top top = top_of(correlations(reference.smooth, other.smooth, 0, longest_lag(instrument)));
        clock.correlation = std::max(0.0, top.correlation);
        const bool same_log = instrument.log == survey_.instruments[survey_.compared.front()].log;
        if (!same_log && !survey_.one_epoch && top.correlation < same_motion_correlation)
            return tl::unexpected(
                fmt::format("{} and {} do not show the same motion: their rates of turn correlate by {:.2f} at best, {} is needed "
                            "(offsets up to {} s were tried)",
                            survey_.logs.front().name, survey_.logs[instrument.log].name, clock.correlation, same_motion_correlation,
                            other_epoch_lag_s));
        if (top.correlation < tied_correlation && (same_log || survey_.one_epoch)) return {};
        if (!top.inside || top.curvature > -least_curvature || lag_error_s(reference, other, top) > largest_lag_error_s) return {};
        clock.tied = true;
        clock.offset_s = top.lag * grid_s;
        fit_slope(reference, other, clock);
        return {};
    }

    /// Offsets of single stretches against their times: a line by least squares, without those that lie far off.
    void fit_slope(const Profiles& reference, const Profiles& other, ClockFigures& clock) const
    {
        struct Point {
            double time_s, offset_s;
        };
        std::vector<Point> points;
        const auto middle = static_cast<std::ptrdiff_t>(std::lround(clock.offset_s / grid_s));
        for (std::size_t i = 0; i < std::min(reference.smooth.size(), other.smooth.size()); ++i) {
            if (reference.smooth[i].empty() || other.smooth[i].empty()) continue;
            Sums sums;
            sums.add(reference.smooth[i], other.smooth[i], middle);
            if (sums.motion() < least_motion_rad_s) continue;
            const Top top = top_of(correlations({reference.smooth[i]}, {other.smooth[i]}, middle, steps_around));
            if (!top.inside || top.correlation < tied_correlation) continue;
            points.push_back({(static_cast<double>(i) + 0.5) * window_s, (static_cast<double>(middle) + top.lag) * grid_s});
        }
        if (points.empty()) return;
        for (int round = 0; round < 3; ++round) {
            double time = 0, offset = 0, squares = 0, products = 0;
            for (const Point& point : points) time += point.time_s, offset += point.offset_s;
            time /= static_cast<double>(points.size());
            offset /= static_cast<double>(points.size());
            for (const Point& point : points) {
                squares += (point.time_s - time) * (point.time_s - time);
                products += (point.time_s - time) * (point.offset_s - offset);
            }
            const double slope = points.size() >= fewest_for_slope && squares > 0 ? products / squares : 0;
            double spread = 0;
            for (const Point& point : points) spread += std::pow(point.offset_s - offset - slope * (point.time_s - time), 2);
            spread = std::sqrt(spread / static_cast<double>(points.size()));
            const double slope_error = squares > 0 ? spread / std::sqrt(squares) : 0;
            clock.slope = std::abs(slope) > 3 * slope_error ? slope : 0;
            clock.offset_s = offset - clock.slope * time;
            clock.uncertainty_s = spread;
            std::erase_if(points, [&](const Point& point) {
                return std::abs(point.offset_s - clock.offset_s - clock.slope * point.time_s) > 3 * spread + 1e-6;
            });
            if (points.empty()) return;
        }
    }

    Survey& survey_;
};

}  // namespace

tl::expected<void, std::string> tie_clocks(Survey& survey)
{
    if (!survey.compared.empty())
        if (auto tied = Tie(survey).all(); !tied) return tied;
    for (SurveyedInstrument& instrument : survey.instruments) instrument.windows = {};
    return {};
}

}  // namespace quorient::recording
