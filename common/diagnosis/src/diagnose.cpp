#include "quorient/diagnosis/diagnose.hpp"

#include "aftermath.hpp"
#include "facts.hpp"
#include "findings.hpp"
#include "fit.hpp"
#include "peers.hpp"
#include "plotter.hpp"
#include "rates.hpp"
#include "watch.hpp"
#include "words.hpp"

#include "quorient/diagnosis/words.hpp"
#include "quorient/fdi/methods.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::diagnosis {
namespace {

constexpr double least_coverage = 0.5;

double begin_of(const recording::AlignedFrame& frame)
{
    return static_cast<double>(frame.time_ns) * 1e-9 - frame.interval_s;
}
double end_of(const recording::AlignedFrame& frame)
{
    return static_cast<double>(frame.time_ns) * 1e-9;
}

std::vector<recording::SurveyedInstrument> compared_of(const recording::Survey& survey)
{
    std::vector<recording::SurveyedInstrument> compared;
    for (const std::size_t i : survey.compared) compared.push_back(survey.instruments[i]);
    return compared;
}

std::vector<std::string> names_of(const std::vector<recording::SurveyedInstrument>& instruments)
{
    std::vector<std::string> names;
    for (const auto& instrument : instruments) names.push_back(instrument.instrument.name);
    return names;
}

fdi::DetectorSettings settings_of(const Options& options, fdi::Mount mount, bool calibrated)
{
    fdi::DetectorSettings settings;
    settings.method = "field";
    settings.sensor_class = options.sensor_class;
    settings.mount = mount;
    settings.calibrated = calibrated;
    return settings;
}

fdi::Mount mount_of(const recording::Survey& survey, const Options& options)
{
    return options.mount.value_or(survey.logs.size() > 1 ? fdi::Mount::structure : fdi::Mount::board);
}

/// The passes over one log's frames, one after the other.
class Passes {
public:
    Passes(const recording::Survey& survey, Frames& frames, const Options& options)
        : survey_(survey), frames_(frames), options_(options), instruments_(compared_of(survey)), names_(names_of(instruments_)),
          overview_(instruments_.size())
    {
        for (const recording::SurveyedLog& log : survey.logs) {
            report_.log += (report_.log.empty() ? "" : ", ") + log.name;
            for (const std::string& remark : log.remarks) report_.remarks.push_back(placed(remark, log));
            if (!log.problems.empty()) report_.remarks.push_back(refused(log));
        }
        report_.remarks.insert(report_.remarks.end(), survey.remarks.begin(), survey.remarks.end());
        report_.mount = mount_of(survey, options);
        report_.instruments = logged_facts(survey);
    }

    Report run()
    {
        look();
        if (instruments_.size() >= 2) compare();
        for (const auto& found : {findings_of_ranges(survey_, instruments_), findings_of_times(instruments_)})
            report_.findings.insert(report_.findings.end(), found.begin(), found.end());
        number_as_reported();
        remark_on_coverage();
        remark_on_times();
        remark_on_selection();
        drop_repeated_remarks();
        report_.sentence = sentence_of(report_);
        return std::move(report_);
    }

private:
    /// What was assumed alike of all logs is said once; else it goes with the log's name.
    std::string placed(const std::string& remark, const recording::SurveyedLog& log) const
    {
        const auto head_of = [](const std::string& text) { return text.substr(0, text.find(", since")); };
        const auto says_it = [&](const recording::SurveyedLog& other) {
            return std::any_of(other.remarks.begin(), other.remarks.end(), [&](const std::string& its) { return head_of(its) == head_of(remark); });
        };
        if (!std::all_of(survey_.logs.begin(), survey_.logs.end(), says_it)) return log.name + ": " + remark;
        for (const std::string& first : survey_.logs.front().remarks)
            if (head_of(first) == head_of(remark)) return first;
        return remark;
    }

    static std::string refused(const recording::SurveyedLog& log)
    {
        return fmt::format("{} refused; the first: {}", counted(log.refused, "record"), log.problems.front());
    }

    InstrumentFacts& facts_of(std::size_t m) { return report_.instruments[survey_.compared[m]]; }

    void look()
    {
        report_.coverage = survey_.compared.empty() ? 0 : 1;
        for (std::size_t m = 0; m < instruments_.size(); ++m) report_.coverage = std::min(report_.coverage, instruments_[m].figures.coverage);
        if (!instruments_.empty())
            frames_.each([&](const recording::AlignedFrame& frame) {
                if (frame.after_gap && overview_.frames() > 0) report_.holes.push_back({overview_.last_s(), begin_of(frame)});
                overview_.add(frame);
            });
        overview_.finish();
        report_.duration_s = overview_.last_s() - overview_.first_s();
        if (instruments_.empty())
            for (const auto& facts : report_.instruments) report_.duration_s = std::max(report_.duration_s, facts.figures.duration_s());
        report_.rests = overview_.rests();
        for (std::size_t m = 0; m < instruments_.size(); ++m) add_rest_facts(overview_, m, facts_of(m));
    }

    void compare()
    {
        const Mountings mountings = find_mountings(overview_, instruments_);
        Array array(mountings, instruments_, options_.reference, frames_.interval_s());
        auto detector = fdi::make_detector(settings_of(options_, report_.mount, array.calibrated()), array.cluster());
        if (!detector) {
            report_.remarks.push_back(detector.error());
            report_.findings = findings_of_setup(overview_, mountings);
            return;
        }
        Watch watch(array.cluster(), std::move(*detector));
        Plotter plotter(instruments_.size(), overview_.first_s(), overview_.last_s());
        detect(array, watch, plotter);
        look_again(array, watch);

        Aftermath aftermath(array, watch.isolations());
        frames_.each([&](const recording::AlignedFrame& frame) {
            aftermath.add(frame);
            plotter.add_attitude(end_of(frame), aftermath.with_deg(), aftermath.alone_deg());
        });
        aftermath.finish();
        report_.attitude = aftermath.attitude();
        report_.plot = plotter.take();
        std::uint32_t sound = (1U << instruments_.size()) - 1;
        for (const Isolation& isolation : watch.isolations()) sound &= ~(1U << isolation.instrument);
        for (std::size_t m = 0; m < instruments_.size(); ++m) add_compared_facts(overview_, mountings, aftermath, m, sound, facts_of(m));
        report_.findings = findings_of({overview_, mountings, watch, aftermath, instruments_});
        remark_on_flexing(aftermath.flexing());
    }

    /// An instrument that was faulty from the first sample has misled the detector about the others until it was named. What is held against
    /// them is looked at again without it.
    void look_again(Array& array, Watch& watch)
    {
        AxisMask from_the_first = 0;
        for (const Isolation& isolation : watch.isolations())
            if (isolation.from_s <= overview_.first_s()) from_the_first |= AxisMask{7} << (3 * isolation.instrument);
        if (from_the_first == 0) return;
        auto detector = fdi::make_detector(settings_of(options_, report_.mount, array.calibrated()), array.cluster());
        if (!detector) return;
        Watch again(array.cluster(), std::move(*detector), from_the_first);
        std::uint64_t sequence = 0;
        frames_.each([&](const recording::AlignedFrame& frame) {
            if (frame.after_gap) ++sequence;
            again.add(array.measurement(frame, sequence++), begin_of(frame), end_of(frame));
        });
        again.finish();
        watch.replace_all_but(from_the_first, again);
    }

    void remark_on_flexing(const Flexing& flexing)
    {
        const auto ratio = flexing.largest();
        if (!ratio || ratio->differing < 2) return;
        report_.remarks.push_back(fmt::format(
            "vibration above 5 Hz: {} {} shows {:.2f} of what the others show, below 5 Hz 1.00: separate boxes on a frame that flexes{}",
            names_[ratio->instrument], "xyz"[ratio->axis], ratio -> ratio,
            report_.mount == fdi::Mount::structure ? "" : " (--mount structure)"));
    }

    void detect(Array& array, Watch& watch, Plotter& plotter)
    {
        Peers peers(overview_, instruments_, frames_.interval_s());
        std::uint64_t sequence = 0;
        frames_.each([&](const recording::AlignedFrame& frame) {
            if (frame.after_gap) ++sequence;
            watch.add(array.measurement(frame, sequence++), begin_of(frame), end_of(frame));
            peers.add(frame);
            plotter.add(end_of(frame), array, frame, watch.assessment());
        });
        watch.finish();
        report_.peers = peers.findings(names_);
    }

    /// From numbers among the compared instruments to numbers among all.
    void number_as_reported()
    {
        for (Finding& finding : report_.findings) {
            if (finding.instrument) finding.instrument = survey_.compared[*finding.instrument];
            for (InstrumentIndex& candidate : finding.candidates) candidate = survey_.compared[candidate];
        }
        if (report_.attitude) report_.attitude->left_out = survey_.compared[report_.attitude->left_out];
    }

    void remark_on_coverage()
    {
        std::vector<std::string> partial;
        double least = 1;
        for (const InstrumentFacts& facts : report_.instruments) {
            if (facts.figures.coverage >= least_coverage) continue;
            partial.push_back(facts.name);
            least = std::min(least, facts.figures.coverage);
        }
        if (partial.empty()) return;
        report_.remarks.push_back(
            fmt::format("{} hold {:.0f} % of the motion: too little to integrate or to compare; log all gyros at full rate "
                        "(PX4: SDLOG_PROFILE with high rate and sensor comparison; ArduPilot: LOG_BITMASK with fast or raw IMU)",
                        list_of(partial), 100 * least));
    }

    void remark_on_times()
    {
        for (const std::size_t i : survey_.compared) {
            const recording::SurveyedInstrument& instrument = survey_.instruments[i];
            const std::string& name = instrument.instrument.name;
            for (const recording::RateChange& change : instrument.rate_changes)
                report_.remarks.push_back(fmt::format("{}: {:.1f} samples a second from {:.1f} s on, usually {:.1f}", name, change.rate_hz,
                                                      change.from_s, instrument.figures.rate_hz()));
            if (!instrument.clock.own_clock) continue;
            const std::uint64_t lost = instrument.clock.lost;
            report_.remarks.push_back(
                fmt::format("{}: stamps come up to {:.0f} ms late ({:.1f} ms for most); its samples were placed on its own clock{}", name,
                            instrument.clock.late_most_s * 1e3, instrument.clock.late_median_s * 1e3,
                            lost == 0 ? "" : fmt::format(", with room left for {}", counted(lost, "lost one"))));
        }
    }

    /// Each is said once, however many logs say it.
    void drop_repeated_remarks()
    {
        std::vector<std::string> once;
        for (std::string& remark : report_.remarks)
            if (std::find(once.begin(), once.end(), remark) == once.end()) once.push_back(std::move(remark));
        report_.remarks = std::move(once);
    }

    /// Which instrument the vehicle flew by, where the log says it.
    void remark_on_selection()
    {
        for (std::size_t log = 0; log < survey_.logs.size(); ++log)
            for (const recording::Selection& selection : survey_.logs[log].selections)
                for (const recording::SurveyedInstrument& instrument : survey_.instruments) {
                    if (instrument.log != log || instrument.instrument.device == 0 || instrument.instrument.device != selection.device) continue;
                    const double from_s = static_cast<double>(selection.time_ns - survey_.logs[log].first_ns) * 1e-9;
                    report_.remarks.push_back(
                        fmt::format("the vehicle flew by {} from {:.1f} s on", instrument.instrument.name, std::max(0.0, from_s)));
                    break;
                }
    }

    const recording::Survey& survey_;
    Frames& frames_;
    const Options& options_;
    std::vector<recording::SurveyedInstrument> instruments_;
    std::vector<std::string> names_;
    Overview overview_;
    Report report_;
};

}  // namespace

Report diagnose(const recording::Survey& survey, Frames& frames, const Options& options)
{
    return Passes(survey, frames, options).run();
}

}  // namespace quorient::diagnosis
