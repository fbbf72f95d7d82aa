#include "quorient/recording/survey.hpp"

#include "quorient/messages/time.hpp"
#include "quorient/recording/resampler.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <map>
#include <span>
#include <string_view>
#include <utility>

namespace quorient::recording {
namespace {

constexpr std::size_t most_kept = (std::size_t{64} << 20U) / sizeof(KeptSample);
constexpr std::size_t most_problems = 20;
constexpr std::size_t steps_for_guess = 200;
constexpr double least_coverage = 0.5;  // an instrument that covers less is not compared
constexpr std::uint64_t progress_every = 1U << 14U;

/// Keeps stretches of all instruments of one log, and every second of them less often once there are too many.
class WindowKeeper {
public:
    void keep(std::size_t instrument, const InstrumentSample& sample, std::int64_t origin_ns)
    {
        const std::int64_t since_ns = sample.time_ns - origin_ns;
        if (since_ns < 0) return;
        const auto number = static_cast<std::size_t>(since_ns / nanoseconds(window_s));
        if (number % stride_ != 0 || number > farthest) return;
        if (of_.size() <= instrument) of_.resize(instrument + 1);
        Kept& of = of_[instrument];
        if (of.windows.size() <= number) of.windows.resize(number + 1);
        KeptWindow& window = of.windows[number];
        if (window.empty()) of.begin(window);
        KeptSample kept{sample.time_ns, {}};
        for (std::size_t k = 0; k < 3; ++k) kept.rate_rad_s[k] = static_cast<float>(sample.rate_rad_s[k]);
        window.push_back(kept);
        of.longest = std::max(of.longest, window.size());
        if (++kept_ > limit_) thin_out();
    }

    void limit(std::size_t most) { limit_ = most; }
    std::vector<KeptWindow> take(std::size_t instrument)
    {
        return instrument < of_.size() ? std::move(of_[instrument].windows) : std::vector<KeptWindow>{};
    }

private:
    static constexpr std::size_t farthest = 1U << 16U;  // a fortnight

    /// Stretches of one instrument. Memory that is touched for the first time costs more than a sample's other work, so it is used again.
    struct Kept {
        std::vector<KeptWindow> windows;
        std::vector<KeptWindow> spare;  ///< empty ones, with their memory
        std::size_t longest = 0;        ///< samples in a stretch so far

        void begin(KeptWindow& window)
        {
            if (!spare.empty()) {
                window = std::move(spare.back());
                spare.pop_back();
            }
            window.reserve(longest + longest / 64);
        }

        void give_up(KeptWindow& window)
        {
            if (window.capacity() == 0) return;
            window.clear();
            spare.push_back(std::move(window));
            window = {};
        }
    };

    void thin_out()
    {
        stride_ *= 2;
        kept_ = 0;
        for (Kept& of : of_) {
            for (std::size_t i = 0; i < of.windows.size(); ++i) {
                if (i % stride_ != 0) of.give_up(of.windows[i]);
                kept_ += of.windows[i].size();
            }
        }
    }

    std::vector<Kept> of_;  // by instrument
    std::size_t stride_ = 1;
    std::size_t kept_ = 0;
    std::size_t limit_ = most_kept;
};

/// What the survey of one log holds while it reads.
struct Reading {
    std::vector<InstrumentMeter> meters;
    std::vector<std::optional<PeriodEstimator>> periods;
    std::vector<std::vector<std::int64_t>> first_stamps;  // until a period can be guessed
    WindowKeeper keeper;
    std::optional<std::int64_t> origin_ns;

    void add(const InstrumentSample& sample)
    {
        const std::size_t i = sample.instrument;
        if (meters.size() <= i) {
            meters.resize(i + 1);
            periods.resize(i + 1);
            first_stamps.resize(i + 1);
        }
        if (!origin_ns) origin_ns = sample.time_ns;
        meters[i].add(sample);
        keeper.keep(i, sample, *origin_ns);
        if (periods[i]) {
            periods[i]->add(sample.time_ns);
            return;
        }
        first_stamps[i].push_back(sample.time_ns);
        if (first_stamps[i].size() < steps_for_guess) return;
        const double guess_s = meters[i].figures().period_s;
        if (!(guess_s > 0)) return;
        periods[i].emplace(guess_s);
        for (const std::int64_t stamp_ns : first_stamps[i]) periods[i]->add(stamp_ns);
        first_stamps[i] = {};
    }
};

void note_log(const InstrumentLog& log, SurveyedLog& noted)
{
    noted.format = log.format();
    noted.remarks = log.remarks();
    noted.statistics = log.statistics();
    noted.selections = log.selections();
}

/// The number at the end of a name, "IMU12" or "IMU[2]", and what stands before it.
std::pair<std::string_view, unsigned> numbered(std::string_view name)
{
    const auto last = name.find_last_of("0123456789");
    if (last == std::string_view::npos) return {name, 0};
    const auto before = name.find_last_not_of("0123456789", last);
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    unsigned number = 0;
    std::from_chars(name.data() + begin, name.data() + last + 1, number);
    return {name.substr(0, begin), number};
}

/// A table may begin with the row of any instrument: those of one source that differ in their number are put in its order.
void sort_by_number(std::span<SurveyedInstrument> instruments)
{
    for (auto begin = instruments.begin(); begin != instruments.end();) {
        const auto same = [&](const SurveyedInstrument& other) {
            return other.instrument.source == begin->instrument.source &&
                   numbered(other.instrument.name).first == numbered(begin->instrument.name).first;
        };
        const auto end = std::find_if_not(begin, instruments.end(), same);
        std::stable_sort(begin, end, [](const SurveyedInstrument& a, const SurveyedInstrument& b) {
            return numbered(a.instrument.name).second < numbered(b.instrument.name).second;
        });
        begin = end;
    }
}

tl::expected<void, std::string> survey_log(std::size_t number, std::size_t most, const Progress& progress, Survey& found)
{
    auto opened = open_instruments(found.files[number], found.options);
    if (!opened) return tl::unexpected(opened.error());
    InstrumentLog& log = **opened;
    SurveyedLog& noted = found.logs.emplace_back();
    noted.name = found.files[number].filename().string();
    Reading reading;
    reading.keeper.limit(most);
    InstrumentSample sample;
    std::uint64_t calls = 0;
    for (auto outcome = log.next(sample); outcome != ReadOutcome::end; outcome = log.next(sample)) {
        if (outcome == ReadOutcome::frame) reading.add(sample);
        else if (++noted.refused <= most_problems) noted.problems.push_back(log.problem());
        if (progress && ++calls % progress_every == 0)
            progress((static_cast<double>(number) + log.progress()) / static_cast<double>(found.files.size()));
    }
    note_log(log, noted);
    const std::size_t first = found.instruments.size();
    for (std::size_t i = 0; i < reading.meters.size(); ++i) {
        SurveyedInstrument instrument{log.instruments()[i], number, i, reading.meters[i].figures(), reading.meters[i].rate_changes(), {},
                                      reading.keeper.take(i), {}};
        if (instrument.figures.samples == 0) continue;
        if (reading.periods[i]) instrument.arrival_period_s = reading.periods[i]->period_s();
        found.instruments.push_back(std::move(instrument));
    }
    sort_by_number(std::span(found.instruments).subspan(first));
    for (std::size_t i = first; i < found.instruments.size(); ++i) {
        const InstrumentFigures& figures = found.instruments[i].figures;
        noted.first_ns = i == first ? figures.first_ns : std::min(noted.first_ns, figures.first_ns);
        noted.last_ns = i == first ? figures.last_ns : std::max(noted.last_ns, figures.last_ns);
    }
    return {};
}

/// Whether all logs' clocks show the same time: their spans overlap by half of the shortest.
bool share_an_epoch(const std::vector<SurveyedLog>& logs)
{
    std::int64_t begin_ns = logs.front().first_ns;
    std::int64_t end_ns = logs.front().last_ns;
    std::int64_t shortest_ns = end_ns - begin_ns;
    for (const SurveyedLog& log : logs) {
        begin_ns = std::max(begin_ns, log.first_ns);
        end_ns = std::min(end_ns, log.last_ns);
        shortest_ns = std::min(shortest_ns, log.last_ns - log.first_ns);
    }
    return 2 * (end_ns - begin_ns) > shortest_ns;
}

/// Instruments of one source that hold the motion whole.
struct Group {
    std::string source;
    std::vector<std::size_t> instruments;
    double rate_hz = 0;
};

/// In each log the source with the most instruments that hold the motion whole, the fastest of equals.
void choose_compared(Survey& found)
{
    for (std::size_t log = 0; log < found.logs.size(); ++log) {
        std::vector<Group> groups;
        for (std::size_t i = 0; i < found.instruments.size(); ++i) {
            const SurveyedInstrument& instrument = found.instruments[i];
            if (instrument.log != log || instrument.figures.coverage < least_coverage || instrument.figures.rate_hz() <= 0) continue;
            auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& known) { return known.source == instrument.instrument.source; });
            if (group == groups.end()) group = groups.insert(groups.end(), Group{instrument.instrument.source, {}, 0});
            group->instruments.push_back(i);
            group->rate_hz = std::max(group->rate_hz, instrument.figures.rate_hz());
        }
        const auto worse = [](const Group& a, const Group& b) {
            return a.instruments.size() != b.instruments.size() ? a.instruments.size() < b.instruments.size() : a.rate_hz < b.rate_hz;
        };
        const auto best = std::max_element(groups.begin(), groups.end(), worse);
        if (best == groups.end()) continue;
        for (const Group& group : groups)
            if (&group != &*best) found.remarks.push_back(fmt::format("{} is not compared: {} holds more of the motion", group.source, best->source));
        found.compared.insert(found.compared.end(), best->instruments.begin(), best->instruments.end());
    }
    if (found.compared.size() <= max_triads) return;
    found.remarks.push_back(fmt::format("{} instruments; the first {} are compared", found.compared.size(), max_triads));
    found.compared.resize(max_triads);
}

}  // namespace

tl::expected<Survey, std::string> survey(std::span<const std::filesystem::path> files, const LogOptions& options, const Progress& progress)
{
    if (files.empty()) return tl::unexpected(std::string("no log is named"));
    Survey found;
    found.files.assign(files.begin(), files.end());
    found.options = options;
    for (std::size_t i = 0; i < files.size(); ++i)
        if (auto read = survey_log(i, most_kept / files.size(), progress, found); !read) return tl::unexpected(read.error());
    if (found.instruments.empty()) return tl::unexpected(fmt::format("{}: no gyro in it", files.front().string()));
    for (const SurveyedInstrument& instrument : found.instruments)
        if (instrument.figures.is_beyond_gyros())
            found.remarks.push_back(fmt::format(
                "{}: {} of {} samples are beyond 4500 deg/s, which no gyro reads: the unit is probably wrong (--unit states that of a table)",
                instrument.instrument.name, instrument.figures.beyond_gyros, instrument.figures.samples));
    found.one_epoch = share_an_epoch(found.logs);
    choose_compared(found);
    return found;
}

}  // namespace quorient::recording
