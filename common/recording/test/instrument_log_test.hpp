#pragma once

#include "log_files.hpp"
#include "quorient/recording/instrument_log.hpp"

namespace quorient::recording {

/// What a log gave, from its beginning to its end.
struct Samples {
    std::vector<InstrumentSample> samples;
    std::vector<std::string> problems;
    std::vector<Instrument> instruments;
    std::vector<Selection> selections;
    std::vector<std::string> remarks;
    Statistics statistics;
    std::string format;

    std::vector<std::string> names() const
    {
        std::vector<std::string> found;
        for (const Instrument& instrument : instruments) found.push_back(instrument.name);
        return found;
    }

    /// The samples of one instrument.
    std::vector<InstrumentSample> of(const std::string& name) const
    {
        std::vector<InstrumentSample> found;
        for (const InstrumentSample& sample : samples)
            if (instruments[sample.instrument].name == name) found.push_back(sample);
        return found;
    }
};

inline Samples samples_of(tl::expected<std::unique_ptr<InstrumentLog>, std::string> opened)
{
    if (!opened) {
        ADD_FAILURE() << opened.error();
        return {};
    }
    InstrumentLog& log = **opened;
    Samples read;
    InstrumentSample sample;
    for (auto outcome = log.next(sample); outcome != ReadOutcome::end; outcome = log.next(sample)) {
        if (outcome == ReadOutcome::frame) read.samples.push_back(sample);
        else read.problems.push_back(log.problem());
    }
    EXPECT_EQ(log.next(sample), ReadOutcome::end) << "an ended log stays so";
    EXPECT_EQ(log.statistics().frames, read.samples.size());
    read.instruments = log.instruments();
    read.selections = log.selections();
    read.remarks = log.remarks();
    read.statistics = log.statistics();
    read.format = log.format();
    return read;
}

inline Samples samples_of(std::vector<std::uint8_t> bytes, const LogOptions& options = {}, const std::string& name = "log.x")
{
    return samples_of(open_instruments(std::move(bytes), name, options));
}

inline Samples samples_of(const std::string& text, const LogOptions& options = {}, const std::string& name = "log.csv")
{
    return samples_of(std::vector<std::uint8_t>(text.begin(), text.end()), options, name);
}

/// Why a log in memory is not opened.
inline std::string refusal_of(const std::string& text, const LogOptions& options = {}, const std::string& name = "log.csv")
{
    const auto opened = open_instruments(std::vector<std::uint8_t>(text.begin(), text.end()), name, options);
    return opened ? "it was opened" : opened.error();
}

inline std::filesystem::path field_dir()
{
    return data_dir() / "field";
}

}  // namespace quorient::recording
