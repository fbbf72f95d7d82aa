#include "report/sample_store.hpp"

#include "cli/program.hpp"

#include <unistd.h>
#include <algorithm>

namespace quorient::cli {
namespace {

constexpr std::size_t most_numbers_in_memory = (std::size_t{32} << 20U) / sizeof(double);
constexpr std::size_t page_samples = 2048;
constexpr std::size_t observed = 4096;  // samples from one call of the observer to the next

constexpr unsigned complete = 1;
constexpr unsigned follows = 2;

}  // namespace

bool SampleStore::add(const calibration::Sample& sample)
{
    const unsigned flags = (sample.complete ? complete : 0) | (sample.follows ? follows : 0);
    record_.assign({sample.time_s, sample.interval_s, static_cast<double>(flags)});
    record_.insert(record_.end(), sample.rate.begin(), sample.rate.end());
    ++size_;
    if (!file_ && memory_.size() + record_size_ <= most_numbers_in_memory) {
        if (memory_.empty()) memory_.reserve(most_numbers_in_memory);  // growing would hold it twice
        memory_.insert(memory_.end(), record_.begin(), record_.end());
        return true;
    }
    if (!file_) file_ = temporary_file();
    return file_ && std::fwrite(record_.data(), sizeof(double), record_size_, file_.get()) == record_size_;
}

bool SampleStore::flush()
{
    return !file_ || std::fflush(file_.get()) == 0;
}

calibration::Sample SampleStore::at(std::size_t index) const
{
    if (observer_ && index % observed == 0) observer_(index);
    const double* const kept = record(index);
    calibration::Sample sample;
    sample.time_s = kept[0];
    sample.interval_s = kept[1];
    const auto flags = static_cast<unsigned>(kept[2]);
    sample.complete = (flags & complete) != 0;
    sample.follows = (flags & follows) != 0;
    sample.rate = Eigen::Map<const Eigen::VectorXd>(kept + places_before_rates, static_cast<Eigen::Index>(record_size_ - places_before_rates));
    return sample;
}

const double* SampleStore::record(std::size_t index) const
{
    if (index < in_memory()) return memory_.data() + index * record_size_;
    const std::size_t place = index - in_memory();
    return page(place / page_samples).records.data() + place % page_samples * record_size_;
}

const SampleStore::Page& SampleStore::page(std::size_t number) const
{
    ++reads_;
    const auto known = std::ranges::find(pages_, number, &Page::number);
    Page& page = known != pages_.end() ? *known : *std::ranges::min_element(pages_, {}, &Page::used);
    page.used = reads_;
    if (known != pages_.end()) return page;
    const std::size_t first = number * page_samples;
    page.number = number;
    page.records.resize(std::min(page_samples, size_ - in_memory() - first) * record_size_);
    const std::size_t bytes = page.records.size() * sizeof(double);
    const auto begin = static_cast<off_t>(first * record_size_ * sizeof(double));
    if (::pread(fileno(file_.get()), page.records.data(), bytes, begin) != static_cast<ssize_t>(bytes))
        fail("the samples cannot be read back from the temporary file that holds them");
    return page;
}

}  // namespace quorient::cli
