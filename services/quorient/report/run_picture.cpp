#include "run_picture.hpp"

#include "cli/svg_plot.hpp"
#include "quorient/messages/words.hpp"
#include "time_strip.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <optional>

namespace quorient::report {
namespace {

using cli::Band;
using cli::BarRow;
using cli::Strip;

/// Sample times of a clock, not of a log or a simulation, are shown since the first.
constexpr double clock_s = 1e7;

constexpr std::size_t most_axes_drawn = 6;
constexpr std::size_t most_rows = 24;
constexpr double lane_height = 64;

constexpr const char* fault_ink = "#999999";
constexpr const char* provisional_ink = "#e69f00";
constexpr const char* isolated_ink = "#d55e00";

const char* ink_of(VoteLevel level)
{
    switch (level) {
        case VoteLevel::full:
            return "#56b4e9";
        case VoteLevel::degraded:
            return "#f0e442";
        case VoteLevel::single:
            return "#e69f00";
        case VoteLevel::coasting:
            return "#cc79a7";
        default:
            return "#000000";
    }
}

class Picture {
public:
    Picture(const system::System& system, const evaluation::RunObserver& run, const RunTimeline& timeline)
        : system_(system), run_(run), timeline_(timeline), moments_(timeline.moments())
    {
        span_.from_s = timeline.begin_s() > clock_s ? 0 : timeline.begin_s();
        span_.to_s = span_.from_s + timeline.moment_s() * static_cast<double>(std::max<std::size_t>(1, moments_.size()));
        span_.left = 92;
    }

    std::string text() const
    {
        std::vector<Strip> strips;
        if (has_error()) strips.push_back(error_strip());
        else if (!system_.integrators().empty()) strips.push_back(attitude_strip());
        for (std::size_t place = 0; place < system_.lanes.size(); ++place) strips.push_back(lane_strip(place));
        strips.push_back(axes_strip());
        if (!system_.integrators().empty()) strips.push_back(level_strip());
        return cli::svg_file(system_.name, strips);
    }

private:
    double begin_of(std::size_t moment) const { return span_.from_s + timeline_.moment_s() * static_cast<double>(moment); }

    bool has_error() const
    {
        return std::ranges::any_of(moments_, [](const RunMoment& moment) { return !moment.error_rad.empty(); });
    }

    /// value(moment): an Extent.
    template <class Value>
    Band band(std::string name, std::string ink, const Value& value) const
    {
        Band made{std::move(ink), {}, false, std::max(2.5 * timeline_.moment_s(), 2.5 * system_.interval_s), std::move(name)};
        for (std::size_t i = 0; i < moments_.size(); ++i) {
            const Extent& extent = value(moments_[i]);
            if (!extent.empty()) made.points.push_back({begin_of(i) + timeline_.moment_s() / 2, extent.least, extent.largest});
        }
        return made;
    }

    Band threshold() const
    {
        Band made{"#111111", {}, true, span_.to_s - span_.from_s, "threshold"};
        for (const double time_s : {span_.from_s, span_.to_s}) made.points.push_back({time_s, 1, 1});
        return made;
    }

    Strip error_strip() const
    {
        std::vector<Band> bands;
        auto without = band("without going back to the onset", cli::colour(1), [](const RunMoment& m) { return m.without_rollback_rad; });
        if (!without.points.empty()) bands.push_back(std::move(without));
        bands.push_back(band("voted attitude", cli::colour(0), [](const RunMoment& m) { return m.error_rad; }));
        return cli::band_strip("Attitude error against the truth", "rad", span_, bands, {cli::Spacing::logarithmic});
    }

    Strip attitude_strip() const
    {
        std::vector<Band> bands;
        for (std::size_t i = 0; i < 3; ++i)
            bands.push_back(band(std::array{"roll", "pitch", "yaw"}[i], cli::colour(i), [i](const RunMoment& m) { return m.roll_pitch_yaw_deg[i]; }));
        return cli::band_strip("Voted attitude", "deg", span_, bands);
    }

    /// The axes that the lane ever left out, at most as many as can be distinguished.
    std::vector<std::size_t> accused_by(std::size_t place) const
    {
        AxisMask mask = 0;
        for (const auto& moment : moments_) mask |= moment.lane[place].isolated | moment.lane[place].provisional;
        std::vector<std::size_t> axes;
        for (std::size_t axis = 0; axis < max_axes && axes.size() < most_axes_drawn; ++axis)
            if (has_axis(mask, axis)) axes.push_back(axis);
        return axes;
    }

    Strip lane_strip(std::size_t place) const
    {
        std::vector<Band> bands{threshold(), band("statistic", "#666666", [place](const RunMoment& m) { return m.lane[place].statistic; })};
        const auto accused = accused_by(place);
        for (std::size_t k = 0; k < accused.size(); ++k)
            bands.push_back(band("residual of " + run_.names_of(axis_bit(accused[k])), cli::colour(k + 1),
                                 [place, axis = accused[k]](const RunMoment& m) { return m.lane[place].residual[axis]; }));
        return cli::band_strip(fmt::format("Lane {}: how far the axes contradict each other", system_.lanes[place].name), "of threshold",
                               span_, bands, {cli::Spacing::logarithmic, lane_height});
    }

    /// Where state(moment) stays the same, one piece; nothing where it is absent. look(state): colour and text.
    template <class State, class Look>
    BarRow row(std::string label, const State& state, const Look& look) const
    {
        BarRow made{std::move(label), {}};
        for (std::size_t begin = 0; begin < moments_.size();) {
            const auto its = state(moments_[begin]);
            std::size_t end = begin + 1;
            while (end < moments_.size() && state(moments_[end]) == its) ++end;
            if (its) {
                const auto [ink, text] = look(*its);
                made.pieces.push_back({begin_of(begin), begin_of(end), ink, text});
            }
            begin = end;
        }
        return made;
    }

    enum class Exclusion { provisional, isolated };

    BarRow fault_row(std::size_t axis) const
    {
        return row(
            run_.names_of(axis_bit(axis)) + ", truth",
            [axis](const RunMoment& m) { return has_axis(m.faulty, axis) ? std::optional(true) : std::nullopt; },
            [](bool) { return std::pair<std::string, std::string>(fault_ink, "faulty"); });
    }

    BarRow exclusion_row(std::size_t place, std::size_t axis) const
    {
        const auto state = [place, axis](const RunMoment& m) -> std::optional<Exclusion> {
            if (has_axis(m.lane[place].isolated, axis)) return Exclusion::isolated;
            if (has_axis(m.lane[place].provisional, axis)) return Exclusion::provisional;
            return std::nullopt;
        };
        return row(fmt::format("{}, lane {}", run_.names_of(axis_bit(axis)), system_.lanes[place].name), state, [](Exclusion its) {
            return its == Exclusion::isolated ? std::pair<std::string, std::string>(isolated_ink, "isolated")
                                              : std::pair<std::string, std::string>(provisional_ink, "left out");
        });
    }

    Strip axes_strip() const
    {
        std::vector<BarRow> rows;
        for (std::size_t axis = 0; axis < max_axes; ++axis) {
            if (auto faulty = fault_row(axis); !faulty.pieces.empty()) rows.push_back(std::move(faulty));
            for (std::size_t place = 0; place < system_.lanes.size(); ++place)
                if (auto left_out = exclusion_row(place, axis); !left_out.pieces.empty()) rows.push_back(std::move(left_out));
        }
        std::string title = rows.empty() ? "Axes left out: none" : "Axes left out";
        if (rows.size() > most_rows) {
            title += fmt::format(" (the first {} of {} rows)", most_rows, rows.size());
            rows.resize(most_rows);
        }
        return cli::row_strip(title, span_, rows);
    }

    Strip level_strip() const
    {
        const auto state = [](const RunMoment& m) { return m.level == VoteLevel::unknown ? std::nullopt : std::optional(m.level); };
        const auto look = [](VoteLevel level) { return std::pair<std::string, std::string>(ink_of(level), to_string(level)); };
        return cli::row_strip("Level of the output", span_, {row("voted", state, look)});
    }

    const system::System& system_;
    const evaluation::RunObserver& run_;
    const RunTimeline& timeline_;
    const std::vector<RunMoment>& moments_;
    cli::TimeSpan span_;
};

}  // namespace

std::string run_picture(const system::System& system, const evaluation::RunObserver& run, const RunTimeline& timeline)
{
    return Picture(system, run, timeline).text();
}

}  // namespace quorient::report
