#pragma once

#include "history.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace quorient::attitude {

/// The samples that an update looks back at: those before the record that is integrated next, and then that record.
/// It holds what the history holds as well, so that a step of the integration moves a few samples instead of visiting as many records.
class IntegrationWindow {
public:
    void clear() { size_ = 0; }

    /// The record at `index` joins the newest `count` samples before it. @returns all of them, oldest first.
    std::span<const Sample> advance(const History& history, std::size_t index, std::size_t count)
    {
        const Record& record = history[index];
        if (next_sequence_ == record.first_sequence && size_ >= count) {
            const auto begin = samples_.begin();
            std::move(begin + static_cast<std::ptrdiff_t>(size_ - count), begin + static_cast<std::ptrdiff_t>(size_), begin);
        } else {
            assert(count <= index);
            for (std::size_t i = 0; i < count; ++i) samples_[i] = sample_of(history[index - count + i]);
        }
        samples_[count] = sample_of(record);
        size_ = count + 1;
        next_sequence_ = record.last_sequence + 1;
        return std::span(samples_).first(size_);
    }

    /// Whether it holds nothing but the newest samples before the record at `index`, or is not of use for that record.
    bool agrees_with(const History& history, std::size_t index) const
    {
        if (size_ == 0 || index == 0 || next_sequence_ != history[index - 1].last_sequence + 1) return true;
        for (std::size_t back = 1; back <= std::min(size_, index); ++back)
            if (samples_[size_ - back].increment != history[index - back].body) return false;
        return true;
    }

private:
    static Sample sample_of(const Record& record) { return {record.body, record.interval_s}; }

    std::array<Sample, longest_memory> samples_{};  // the first size_ of them
    std::size_t size_ = 0;
    std::uint64_t next_sequence_ = 0;  // where the record after the newest sample begins
};

}  // namespace quorient::attitude
