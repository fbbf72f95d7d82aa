#pragma once

#include "quorient/calibration/sample.hpp"
#include "temporary_file.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace quorient::cli {

inline constexpr auto no_room_for_samples = "no room for the samples: a calibration needs a temporary file, in $TMPDIR or /var/tmp";

/// A recording's samples for a calibration: the first 32 MB in memory, the rest in a temporary file that goes with the process.
/// Read back, they are the same to the last bit.
class SampleStore final : public calibration::SampleSource {
public:
    /// @param axes  of each sample
    explicit SampleStore(std::size_t axes) : record_size_(places_before_rates + axes) {}

    /// @returns false where the disk takes no more: the store is of no use from then on.
    bool add(const calibration::Sample& sample);

    /// After the last sample. @returns false where the disk has not taken them all.
    bool flush();

    std::size_t size() const override { return size_; }

    /// @throws Exit{2} after explaining on stderr that the file cannot be read back.
    calibration::Sample at(std::size_t index) const override;

    /// Called with the place of a sample that is read, now and then.
    void on_read(std::function<void(std::size_t index)> observer) { observer_ = std::move(observer); }

private:
    static constexpr std::size_t places_before_rates = 3;  ///< time, interval, flags

    /// Samples in a row, read back together.
    struct Page {
        std::size_t number = SIZE_MAX;
        std::uint64_t used = 0;  ///< when, in counts of reads
        std::vector<double> records;
    };

    std::size_t in_memory() const { return memory_.size() / record_size_; }
    const double* record(std::size_t index) const;
    const Page& page(std::size_t number) const;

    std::size_t record_size_;  ///< in doubles
    std::size_t size_ = 0;
    std::vector<double> memory_;
    std::vector<double> record_;  ///< the one that is being added
    TemporaryFile file_;
    std::function<void(std::size_t)> observer_;
    mutable std::array<Page, 8> pages_;  ///< an Allan deviation reads at three places in turn
    mutable std::uint64_t reads_ = 0;
};

}  // namespace quorient::cli
