#include "report/diagnosis_page.hpp"

#include "cli/svg_plot.hpp"
#include "report/diagnosis_text.hpp"
#include "report/time_strip.hpp"

#include "quorient/diagnosis/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace quorient::cli {
namespace {

using diagnosis::Certainty;
using diagnosis::Report;

constexpr std::string_view style =
    "body{font-family:sans-serif;max-width:60em;margin:1em auto;padding:0 .8em;color:#111;background:#fff;line-height:1.35}"
    "h1{font-size:1.25em;padding:.5em .7em;border-left:.5em solid #009e73;background:#f3f3f3}h1.isolated{border-color:#d00000}"
    "h1.detected{border-color:#e69f00}h1.open{border-color:#888}h2{font-size:1.05em;margin:1.4em 0 .3em}.keys span{display:inline-block;max-width:100%;margin-right:1em;overflow-wrap:anywhere}"
    ".keys i{display:inline-block;width:1.2em;height:.6em;margin-right:.3em}ul{padding-left:1.2em;margin:.3em 0}"
    "pre{font-size:12px;white-space:pre-wrap;overflow-wrap:anywhere}figure .l{mix-blend-mode:multiply}@media print{body{margin:0;max-width:none}h1{background:none}}";

constexpr BandLook rates_look{Spacing::linear, 150};
constexpr double label_width = 46;
constexpr int most_page_ticks = 5;  // their labels have room on a phone

/// The compared instruments, by their places in the report.
std::vector<std::size_t> compared_of(const Report& report)
{
    std::vector<std::size_t> compared;
    for (std::size_t m = 0; m < report.instruments.size(); ++m)
        if (report.instruments[m].compared) compared.push_back(m);
    return compared;
}

/// Up to the last bin that holds something.
TimeSpan span_of(const diagnosis::Plot& plot)
{
    const auto last = std::find_if(plot.bins.rbegin(), plot.bins.rend(), [](const diagnosis::PlotBin& bin) { return bin.filled; });
    const double length_s = plot.bin_s * static_cast<double>(std::distance(last, plot.bins.rend()));
    return {plot.first_s, plot.first_s + std::max(1e-3, length_s), label_width, most_page_ticks};
}

class Page {
public:
    explicit Page(const Report& report) : report_(report), compared_(compared_of(report)), span_(span_of(report.plot)) {}

    std::string text() const
    {
        std::string page =
            "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width, initial-scale=1'>\n";
        page += fmt::format("<title>{}</title>\n<style>{}{}</style></head><body>\n", markup_escaped(report_.log), style, figure_style);
        const std::string_view state = !report_.findings.empty() ? name_of(report_.findings.front().certainty) : report_.judged() ? "" : "open";
        page += fmt::format("<h1 class='{}'>{}</h1>\n<p>{}: {:.1f} s</p>\n", state, markup_escaped(report_.sentence),
                            markup_escaped(report_.log), report_.logged_s());
        page += findings();
        if (!report_.plot.bins.empty()) page += diagrams();
        page += fmt::format("<h2>All figures</h2>\n<pre>{}</pre>\n", markup_escaped(diagnosis_text(report_)));
        return page + "</body></html>\n";
    }

private:
    std::string findings() const
    {
        if (report_.findings.empty()) return "<h2>Findings</h2>\n<p>None.</p>\n";
        std::string text = "<h2>Findings</h2>\n<ul>\n";
        for (const auto& finding : report_.findings)
            text += fmt::format("<li><b>{}</b>: {}</li>\n", name_of(finding.certainty), markup_escaped(statement_of(finding, report_)));
        return text + "</ul>\n";
    }

    std::string diagrams() const
    {
        std::string text = "<h2>Over time</h2>\n<p class='keys'>";
        for (std::size_t m = 0; m < compared_.size(); ++m)
            text += fmt::format("<span><i style='background:{}'></i>{}</span>", colour(m), markup_escaped(report_.instruments[compared_[m]].name));
        text += "</p>\n";
        if (!report_.findings.empty()) text += figure_element(bar_strip("Findings", span_, bars()));
        for (int axis = 0; axis < 3; ++axis)
            text +=
                figure_element(band_strip(fmt::format("Rate about {}, all gyros", "xyz"[axis]), "deg/s", span_, rates(axis), rates_look));
        for (std::size_t m = 0; m < compared_.size() && was_watched(); ++m) {
            const std::string& name = report_.instruments[compared_[m]].name;
            text +=
                figure_element(band_strip(fmt::format("{}: deviation from the others, and what it stays below while sound (dashed)", name),
                                          "deg/s", span_, residuals(m)));
        }
        if (report_.attitude) {
            const std::string& name = report_.instruments[report_.attitude->left_out].name;
            text += figure_element(
                band_strip(fmt::format("Attitude with {0} among the others; by {0} alone (dashed)", name), "deg", span_, attitudes()));
        }
        return text;
    }

    /// The detector has said what it expects: a log of half a second ends before that.
    bool was_watched() const
    {
        const auto has_bound = [](const diagnosis::PlotBin& bin) {
            return std::any_of(bin.of.begin(), bin.of.end(), [](const diagnosis::PlotBin::Instrument& one) { return one.bound_deg_s > 0; });
        };
        return std::any_of(report_.plot.bins.begin(), report_.plot.bins.end(), has_bound);
    }

    static std::string_view short_words(const diagnosis::Finding& finding)
    {
        if (finding.kind != diagnosis::Kind::bias || std::isfinite(finding.size)) return name_of(finding.kind);
        return finding.instrument ? "contradicts the others" : "disagree";
    }

    std::vector<Bar> bars() const
    {
        std::vector<Bar> found;
        for (const auto& finding : report_.findings) {
            const bool certain = finding.certainty == Certainty::isolated;
            const bool detected = finding.certainty == Certainty::detected;
            const std::string_view colour = certain ? "#d00000" : detected ? "#e69f00" : "#999999";
            found.push_back({fmt::format("{} {}", place_of(finding, report_), short_words(finding)), std::string(colour), finding.from_s,
                             finding.to_s.value_or(span_.to_s)});
        }
        return found;
    }

    /// value(bin, instrument): least and largest.
    template <class Value>
    Band band_of(std::string ink, bool dashed, std::size_t m, const Value& value) const
    {
        Band band{std::move(ink), {}, dashed, std::max(2.5 * report_.plot.bin_s, 0.25)};
        for (std::size_t i = 0; i < report_.plot.bins.size(); ++i) {
            const diagnosis::PlotBin& bin = report_.plot.bins[i];
            if (!bin.filled || bin.of[m].frames == 0) continue;
            const auto [least, largest] = value(bin);
            band.points.push_back({span_.from_s + (static_cast<double>(i) + 0.5) * report_.plot.bin_s, least, largest});
        }
        return band;
    }

    std::vector<Band> rates(int axis) const
    {
        std::vector<Band> bands;
        for (std::size_t m = 0; m < compared_.size(); ++m)
            bands.push_back(band_of(colour(m), false, m, [&](const diagnosis::PlotBin& bin) {
                return std::pair<double, double>(bin.of[m].least_deg_s(axis), bin.of[m].largest_deg_s(axis));
            }));
        return bands;
    }

    std::vector<Band> residuals(std::size_t m) const
    {
        const auto residual = [&](const diagnosis::PlotBin& bin) {
            return std::pair<double, double>(bin.of[m].residual_deg_s, bin.of[m].residual_deg_s);
        };
        const auto bound = [&](const diagnosis::PlotBin& bin) { return std::pair<double, double>(bin.of[m].bound_deg_s, bin.of[m].bound_deg_s); };
        return {band_of(colour(m), false, m, residual), band_of("#111111", true, m, bound)};
    }

    std::vector<Band> attitudes() const
    {
        const auto with = [](const diagnosis::PlotBin& bin) { return std::pair<double, double>(bin.with_deg, bin.with_deg); };
        const auto alone = [](const diagnosis::PlotBin& bin) { return std::pair<double, double>(bin.alone_deg, bin.alone_deg); };
        return {band_of("#0072b2", false, 0, with), band_of("#d00000", true, 0, alone)};
    }

    const Report& report_;
    std::vector<std::size_t> compared_;
    TimeSpan span_;
};

}  // namespace

std::string diagnosis_page(const Report& report)
{
    return Page(report).text();
}

}  // namespace quorient::cli
