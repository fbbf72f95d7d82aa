#include "quorient/recording/csv_writer.hpp"

#include <fmt/format.h>
#include <cassert>
#include <iterator>

namespace quorient::recording {

CsvWriter::CsvWriter(std::ostream& out, std::size_t axis_count, bool with_truth)
    : out_(out), axis_count_(axis_count), with_truth_(with_truth)
{
    out_ << "time";
    for (std::size_t axis = 0; axis < axis_count_; ++axis) out_ << ",increment_" << axis;
    if (with_truth_) out_ << ",truth_w,truth_x,truth_y,truth_z";
    out_ << '\n';
}

void CsvWriter::write(const SensorFrame& frame, const TruthState* truth)
{
    assert(frame.axis_count == axis_count_ && (truth != nullptr) == with_truth_);
    fmt::memory_buffer row;
    auto place = std::back_inserter(row);
    fmt::format_to(place, "{}.{:09}", frame.sample_time_ns / 1'000'000'000, frame.sample_time_ns % 1'000'000'000);
    for (std::size_t axis = 0; axis < axis_count_; ++axis) {
        if (has_axis(frame.valid_mask, axis)) fmt::format_to(place, ",{:.17g}", frame.increment[axis]);
        else fmt::format_to(place, ",nan");
    }
    if (with_truth_)
        for (const double component : truth->attitude) fmt::format_to(place, ",{:.17g}", component);
    row.push_back('\n');
    out_.write(row.data(), static_cast<std::streamsize>(row.size()));
}

}  // namespace quorient::recording
