#include "bag_directory.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::recording::ros {
namespace {

/// Logs one after the other, as if they were one.
class LogSequence final : public InstrumentLog {
public:
    explicit LogSequence(std::vector<std::unique_ptr<InstrumentLog>> parts) : parts_(std::move(parts)) { format_ = parts_.front()->format(); }

    ReadOutcome next(InstrumentSample& sample) override
    {
        for (; part_ < parts_.size(); ++part_) {
            InstrumentLog& log = *parts_[part_];
            const auto outcome = log.next(sample);
            count(log.statistics());
            if (outcome == ReadOutcome::rejected) problem_ = log.problem();
            if (outcome == ReadOutcome::frame) sample.instrument = place(sample.instrument);
            if (outcome != ReadOutcome::end) return outcome;
            done_ = statistics_;
            remarks_.insert(remarks_.end(), log.remarks().begin(), log.remarks().end());
            places_.clear();
        }
        return ReadOutcome::end;
    }

    double progress() const override
    {
        const double inside = part_ < parts_.size() ? parts_[part_]->progress() : 0.0;
        return (static_cast<double>(part_) + inside) / static_cast<double>(parts_.size());
    }

private:
    /// The place in this log of an instrument of the part in hand. Instruments beyond max_instruments share the last place.
    std::size_t place(std::size_t in_part)
    {
        const auto& instruments = parts_[part_]->instruments();
        while (places_.size() < instruments.size()) places_.push_back(place_of(instruments[places_.size()]).value_or(max_instruments - 1));
        return places_[in_part];
    }

    void count(const Statistics& part)
    {
        statistics_.records = done_.records + part.records;
        statistics_.frames = done_.frames + part.frames;
        statistics_.checksum_failures = done_.checksum_failures + part.checksum_failures;
        statistics_.malformed = done_.malformed + part.malformed;
        statistics_.incomplete = done_.incomplete + part.incomplete;
        statistics_.skipped_bytes = done_.skipped_bytes + part.skipped_bytes;
        statistics_.truncated_bytes = done_.truncated_bytes + part.truncated_bytes;
    }

    std::vector<std::unique_ptr<InstrumentLog>> parts_;
    std::size_t part_ = 0;               // the one in hand
    std::vector<std::size_t> places_;    // its instruments' places in this log
    Statistics done_;                    // counts of the parts before
};

}  // namespace

tl::expected<std::unique_ptr<InstrumentLog>, std::string> open_bag_directory(const std::filesystem::path& directory)
{
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(directory, error))
        if (entry.is_regular_file() && entry.path().extension() != ".yaml") files.push_back(entry.path());
    if (error) return tl::unexpected(fmt::format("{}: {}", directory.string(), error.message()));
    std::sort(files.begin(), files.end());
    std::vector<std::unique_ptr<InstrumentLog>> parts;
    for (const auto& file : files) {
        auto log = open_instruments(file);
        if (!log) return tl::unexpected(log.error());
        if ((*log)->format() != "MCAP" && (*log)->format() != "ROS 2 bag, sqlite3")
            return tl::unexpected(fmt::format("{}: a folder is read as a ROS 2 bag, and this file is none of a bag's; name the log itself",
                                              file.string()));
        parts.push_back(std::move(*log));
    }
    if (parts.empty()) return tl::unexpected(fmt::format("{}: a folder without a file of a ROS 2 bag (.mcap, .db3)", directory.string()));
    return std::make_unique<LogSequence>(std::move(parts));
}

}  // namespace quorient::recording::ros
