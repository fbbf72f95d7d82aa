#include "quorient/recording/aligned_logs.hpp"

#include "quorient/messages/time.hpp"
#include "stamp_guard.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::recording {

/// What happens to the samples of one compared instrument on their way to the common intervals.
class SampleWay {
public:
    SampleWay(const SurveyedInstrument& instrument, std::int64_t origin_ns)
        : guard_(instrument.figures.period_s), clock_(instrument.clock), origin_ns_(origin_ns)
    {
        if (clock_.own_clock) own_.emplace(clock_.own_period_s);
    }

    /// Calls give(common time, sample) for all samples that can be placed now.
    template <class Give>
    void add(const InstrumentSample& sample, const Give& give)
    {
        good_.clear();
        guard_.add(sample, good_);
        place(give);
    }

    template <class Give>
    void finish(const Give& give)
    {
        good_.clear();
        guard_.finish(good_);
        if (own_) own_->finish();
        place(give);
    }

    std::uint64_t dropped() const { return guard_.dropped(); }

private:
    template <class Give>
    void place(const Give& give)
    {
        if (!own_) {
            for (const InstrumentSample& sample : good_) give(common_ns(sample.time_ns), sample);
            return;
        }
        for (const InstrumentSample& sample : good_) {
            own_->add(sample.time_ns);
            waiting_.push_back(sample);
        }
        while (const auto placed = own_->next()) {
            give(common_ns(placed->time_ns), waiting_.front());
            waiting_.pop_front();
        }
    }

    std::int64_t common_ns(std::int64_t time_ns) const
    {
        const std::int64_t since_ns = time_ns - origin_ns_;
        return since_ns - nanoseconds(clock_.offset_s + clock_.slope * seconds(since_ns));
    }

    StampGuard guard_;
    ClockFigures clock_;
    std::int64_t origin_ns_;
    std::optional<ArrivalClock> own_;
    std::deque<InstrumentSample> waiting_;
    std::vector<InstrumentSample> good_;
};

namespace {

/// The slowest instrument leads: its samples are not cut apart.
ResampleSettings settings_of(const Survey& survey, double fastest_hz)
{
    ResampleSettings settings;
    for (const std::size_t i : survey.compared) settings.period_s.push_back(survey.instruments[i].figures.period_s);
    settings.leader = static_cast<std::size_t>(std::max_element(settings.period_s.begin(), settings.period_s.end()) - settings.period_s.begin());
    const double rate_hz = 1.0 / settings.period_s[settings.leader];
    settings.samples_per_frame = static_cast<std::size_t>(std::max(1.0, std::ceil(rate_hz / fastest_hz - 0.01)));
    return settings;
}

}  // namespace

struct AlignedLogs::State {
    State(const Survey& survey, const ResampleSettings& settings)
        : one_epoch(survey.one_epoch),
          resampler(settings),
          interval_s(settings.period_s[settings.leader] * static_cast<double>(settings.samples_per_frame))
    {
        for (const std::size_t i : survey.compared) {
            const SurveyedInstrument& instrument = survey.instruments[i];
            ways.emplace_back(instrument, survey.one_epoch ? survey.logs.front().first_ns : survey.logs[instrument.log].first_ns);
            instruments.push_back(instrument);
        }
    }

    /// A log that is being read.
    struct Open {
        std::unique_ptr<InstrumentLog> log;
        std::vector<std::optional<std::size_t>> way;  // by the log's instruments, as far as they were seen
        std::int64_t reached_ns = std::numeric_limits<std::int64_t>::min();  // on a clock that all logs share, or since the log's first sample
        std::optional<std::int64_t> first_ns;  // what that time counts from
        bool ended = false;
    };

    std::optional<std::size_t> way_of(std::size_t number, std::size_t place)
    {
        Open& open = logs[number];
        while (open.way.size() <= place) {
            const Instrument& seen = open.log->instruments()[open.way.size()];
            std::optional<std::size_t> way;
            for (std::size_t i = 0; i < instruments.size(); ++i)
                if (instruments[i].log == number && instruments[i].instrument.name == seen.name && instruments[i].instrument.source == seen.source)
                    way = i;
            open.way.push_back(way);
        }
        return open.way[place];
    }

    /// Reads one record of the log that is farthest behind. @returns end where all have ended
    ReadOutcome read()
    {
        auto behind = logs.end();
        for (auto open = logs.begin(); open != logs.end(); ++open)
            if (!open->ended && (behind == logs.end() || open->reached_ns < behind->reached_ns)) behind = open;
        if (behind == logs.end()) return ReadOutcome::end;
        const auto outcome = behind->log->next(sample);
        if (outcome == ReadOutcome::end) behind->ended = true;
        if (outcome == ReadOutcome::rejected) problem = behind->log->problem();
        if (outcome != ReadOutcome::frame) return outcome == ReadOutcome::end ? ReadOutcome::frame : outcome;
        if (!behind->first_ns) behind->first_ns = one_epoch ? 0 : sample.time_ns;
        behind->reached_ns = std::max(behind->reached_ns, sample.time_ns - *behind->first_ns);
        if (const auto way = way_of(static_cast<std::size_t>(behind - logs.begin()), sample.instrument))
            ways[*way].add(sample, [&](std::int64_t time_ns, const InstrumentSample& placed) { resampler.add(*way, time_ns, placed); });
        return ReadOutcome::frame;
    }

    void finish()
    {
        finished = true;
        for (std::size_t i = 0; i < ways.size(); ++i)
            ways[i].finish([&](std::int64_t time_ns, const InstrumentSample& placed) { resampler.add(i, time_ns, placed); });
        resampler.finish();
    }

    bool one_epoch;
    Resampler resampler;
    double interval_s;
    std::vector<Open> logs;
    std::vector<SampleWay> ways;
    std::vector<SurveyedInstrument> instruments;
    InstrumentSample sample;
    std::string problem;
    bool finished = false;
};

AlignedLogs::AlignedLogs(std::unique_ptr<State> state) : state_(std::move(state)) {}
AlignedLogs::AlignedLogs(AlignedLogs&&) noexcept = default;
AlignedLogs& AlignedLogs::operator=(AlignedLogs&&) noexcept = default;
AlignedLogs::~AlignedLogs() = default;

tl::expected<AlignedLogs, std::string> AlignedLogs::open(const Survey& survey, double fastest_hz)
{
    if (survey.compared.empty()) return tl::unexpected(fmt::format("{}: no instrument holds the motion whole", survey.logs.front().name));
    auto state = std::make_unique<State>(survey, settings_of(survey, fastest_hz));
    for (const auto& file : survey.files) {
        auto log = open_instruments(file, survey.options);
        if (!log) return tl::unexpected(log.error());
        state->logs.push_back({std::move(*log), {}, std::numeric_limits<std::int64_t>::min(), {}, false});
    }
    return AlignedLogs(std::move(state));
}

ReadOutcome AlignedLogs::next(AlignedFrame& frame)
{
    for (;;) {
        if (state_->resampler.next(frame)) return ReadOutcome::frame;
        if (state_->finished) return ReadOutcome::end;
        const auto outcome = state_->read();
        if (outcome == ReadOutcome::rejected) return outcome;
        if (outcome == ReadOutcome::end) state_->finish();
    }
}

const std::string& AlignedLogs::problem() const
{
    return state_->problem;
}

double AlignedLogs::interval_s() const
{
    return state_->interval_s;
}

double AlignedLogs::progress() const
{
    double sum = 0;
    for (const auto& open : state_->logs) sum += open.ended ? 1.0 : open.log->progress();
    return sum / static_cast<double>(state_->logs.size());
}

std::vector<std::uint64_t> AlignedLogs::dropped() const
{
    std::vector<std::uint64_t> counts;
    for (const SampleWay& way : state_->ways) counts.push_back(way.dropped());
    return counts;
}

}  // namespace quorient::recording
