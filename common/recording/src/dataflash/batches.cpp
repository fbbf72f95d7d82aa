#include "batches.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::recording::dataflash {
namespace {

constexpr double gyro_batch = 1;  // ISBH.type: 0 = accelerometer

double number_of(Bytes record, const RecordFormat& format, std::string_view field, double otherwise)
{
    const auto place = format.place(field);
    return place ? number_at(record, format.fields[*place]) : otherwise;
}

}  // namespace

void Batches::head(Bytes record, const RecordFormat& format)
{
    Head head;
    head.number = number_of(record, format, "N", -1);
    head.instance = static_cast<unsigned>(std::clamp(number_of(record, format, "instance", 0), 0.0, 255.0));
    head.gyro = number_of(record, format, "type", 0) == gyro_batch;
    head.begin_us = number_of(record, format, "SampleUS", 0);
    const double counts_per_rad_s = number_of(record, format, "mul", 0);
    const double rate_hz = number_of(record, format, "smp_rate", 0);
    if (!(counts_per_rad_s > 0) || !(rate_hz > 0) || !std::isfinite(rate_hz)) return;
    head.scale = 1.0 / counts_per_rad_s;
    head.interval_us = 1e6 / rate_hz;
    newest_ = (newest_ + 1) % heads_.size();
    heads_[newest_] = head;
}

bool Batches::data(Bytes record, const RecordFormat& format)
{
    const auto x = format.place("x");
    const auto y = format.place("y");
    const auto z = format.place("z");
    const double batch = number_of(record, format, "N", -1);
    const auto head = std::find_if(heads_.begin(), heads_.end(), [&](const Head& known) { return known.number == batch; });
    if (!x || !y || !z || batch < 0 || head == heads_.end() || !head->gyro) return false;
    const std::array fields{&format.fields[*x], &format.fields[*y], &format.fields[*z]};
    std::array<std::array<std::int16_t, 32>, 3> counts;
    for (std::size_t k = 0; k < 3; ++k) {
        if (fields[k]->letter != 'a') return false;
        counts[k] = array_at(record, *fields[k]);
    }
    const double first = number_of(record, format, "seqno", 0) * static_cast<double>(counts[0].size());
    for (std::size_t i = 0; i < counts[0].size(); ++i) {
        BatchSample sample{head->instance, head->begin_us + (first + static_cast<double>(i)) * head->interval_us, {}};
        for (std::size_t k = 0; k < 3; ++k) sample.rate_rad_s[k] = counts[k][i] * head->scale;
        waiting_.push_back(sample);
    }
    return true;
}

bool Batches::next(BatchSample& sample)
{
    if (waiting_.empty()) return false;
    sample = waiting_.front();
    waiting_.pop_front();
    return true;
}

}  // namespace quorient::recording::dataflash
