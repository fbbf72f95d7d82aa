#include "quorient/recording/merge.hpp"

#include "aligned_reader.hpp"
#include "turn_profile.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr std::size_t longest_profile = 60'000;  // grid points, ten minutes: what the estimate holds of a log, however long it is

/// Angle turned through by the first triad up to each time of a grid from the log's beginning [rad].
Profile turned_angle(Reader& reader)
{
    Profile angle{0.0};
    double before_s = 0;
    double before_rad = 0;
    RecordedFrame frame;
    for (auto outcome = reader.next(frame); outcome != ReadOutcome::end && angle.size() < longest_profile; outcome = reader.next(frame)) {
        if (outcome == ReadOutcome::rejected) continue;
        const double now_s = static_cast<double>(frame.time_ns) * 1e-9;
        const double now_rad = before_rad + std::hypot(frame.increment[0], frame.increment[1], frame.increment[2]);
        for (double grid = static_cast<double>(angle.size()) * grid_s; grid <= now_s; grid = static_cast<double>(angle.size()) * grid_s)
            angle.push_back(before_rad + (now_rad - before_rad) * (grid - before_s) / (now_s - before_s));
        before_s = now_s;
        before_rad = now_rad;
    }
    return angle;
}

tl::expected<Profile, std::string> rate_profile(const std::filesystem::path& file, const LogOptions& options)
{
    std::vector<std::string> remarks;
    const auto reader = open_log(file, options, remarks);
    if (!reader) return tl::unexpected(reader.error());
    if ((*reader)->description().axis_count < 3) return tl::unexpected(fmt::format("{}: fewer than three axes", file.string()));
    const Profile angle = turned_angle(**reader);
    Profile rate;
    for (std::size_t i = 2 * half_window; i < angle.size(); ++i)
        rate.push_back((angle[i] - angle[i - 2 * half_window]) / (2 * half_window * grid_s));
    return rate;
}

/// Correlation of a(t) with b(t + lag) over their common times; -1 where these are less than half of the shorter one.
double correlation(const Profile& a, const Profile& b, std::ptrdiff_t lag)
{
    const auto size_a = static_cast<std::ptrdiff_t>(a.size());
    const auto size_b = static_cast<std::ptrdiff_t>(b.size());
    const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, -lag);
    const std::ptrdiff_t end = std::min(size_a, size_b - lag);
    if (2 * (end - begin) < std::min(size_a, size_b) || end - begin < 2) return -1;
    const auto count = static_cast<double>(end - begin);
    double sum_a = 0, sum_b = 0, squares_a = 0, squares_b = 0, products = 0;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
        const double x = a[static_cast<std::size_t>(i)];
        const double y = b[static_cast<std::size_t>(i + lag)];
        sum_a += x;
        sum_b += y;
        squares_a += x * x;
        squares_b += y * y;
        products += x * y;
    }
    const double scale = (squares_a - sum_a * sum_a / count) * (squares_b - sum_b * sum_b / count);
    return scale > 0 ? (products - sum_a * sum_b / count) / std::sqrt(scale) : -1;
}

/// The top of the parabola through three neighbouring values, in steps from the middle one.
double parabola_top(double left, double middle, double right)
{
    const double curvature = left - 2 * middle + right;
    return curvature < 0 ? 0.5 * (left - right) / curvature : 0;
}

}  // namespace

tl::expected<ClockOffset, std::string> estimate_offset(const std::filesystem::path& reference, const std::filesystem::path& other,
                                                       double longest_s, const LogOptions& options)
{
    const auto a = rate_profile(reference, options);
    if (!a) return tl::unexpected(a.error());
    const auto b = rate_profile(other, options);
    if (!b) return tl::unexpected(b.error());

    const auto longest = static_cast<std::ptrdiff_t>(std::lround(longest_s / grid_s));
    std::vector<double> values;
    for (std::ptrdiff_t lag = -longest; lag <= longest; ++lag) values.push_back(correlation(*a, *b, lag));
    const auto top = std::max_element(values.begin(), values.end());
    if (*top < same_motion_correlation)
        return tl::unexpected(
            fmt::format("{} and {} do not show the same motion: their rates of turn correlate by {:.2f} at best, {} is needed (offsets "
                        "up to {} s were tried)",
                        reference.string(), other.string(), std::max(0.0, *top), same_motion_correlation, longest_s));
    const auto place = top - values.begin();
    const bool inside = top != values.begin() && top + 1 != values.end();
    const double fine = inside ? parabola_top(*(top - 1), *top, *(top + 1)) : 0;
    return ClockOffset{(static_cast<double>(place - longest) + fine) * grid_s, *top};
}

}  // namespace quorient::recording
