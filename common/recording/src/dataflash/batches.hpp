#pragma once

#include "record_format.hpp"

#include <deque>

namespace quorient::recording::dataflash {

/// A sample of a batch: 32 of them come in one ISBD record.
struct BatchSample {
    unsigned instance = 0;
    double time_us = 0;
    std::array<double, 3> rate_rad_s{};
};

/// Bursts of samples at a sensor's full rate: an ISBH record states instrument, scale, first time and rate; the ISBD records with its
/// number hold the samples.
class Batches {
public:
    void head(Bytes record, const RecordFormat& format);

    /// @returns whether the batch is one of gyros whose head came before.
    bool data(Bytes record, const RecordFormat& format);

    /// The samples of the last data record, one after the other.
    bool next(BatchSample& sample);

private:
    struct Head {
        double number = -1;  // no batch has it
        unsigned instance = 0;
        double scale = 1;  // counts to rad/s
        double begin_us = 0;
        double interval_us = 0;
        bool gyro = false;
    };

    std::array<Head, 8> heads_;  // the latest ones
    std::size_t newest_ = 0;
    std::deque<BatchSample> waiting_;
};

}  // namespace quorient::recording::dataflash
