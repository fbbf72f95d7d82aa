#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

namespace quorient::calibration {

/// One frame of a recording: what each axis measured, as a rate.
struct Sample {
    double time_s = 0;  ///< end of the interval, from the log's beginning
    double interval_s = 0;
    geometry::AxisVector rate;  ///< [rad/s]
    bool complete = true;       ///< every axis is valid
    bool follows = true;        ///< nothing is missing between the sample before and this one
};

/// A recording's samples, wherever they are kept. The fits read them again and again, mostly in order, so that they need no copy.
class SampleSource {
public:
    SampleSource() = default;
    SampleSource(const SampleSource&) = default;
    SampleSource(SampleSource&&) = default;
    SampleSource& operator=(const SampleSource&) = default;
    SampleSource& operator=(SampleSource&&) = default;
    virtual ~SampleSource() = default;

    virtual std::size_t size() const = 0;

    /// @param index  below size()
    virtual Sample at(std::size_t index) const = 0;
};

/// Samples of a recording in a row: a view, as a span is one. Whatever keeps them must outlive it.
class Samples {
public:
    /// Gives samples out in order.
    class Iterator {
    public:
        using iterator_category = std::input_iterator_tag;
        using value_type = Sample;
        using difference_type = std::ptrdiff_t;
        using pointer = void;
        using reference = Sample;

        Iterator(const Samples& samples, std::size_t index) : samples_(&samples), index_(index) {}
        Sample operator*() const { return (*samples_)[index_]; }
        Iterator& operator++()
        {
            ++index_;
            return *this;
        }
        bool operator==(const Iterator& other) const { return index_ == other.index_; }

    private:
        const Samples* samples_;
        std::size_t index_;
    };

    Samples() = default;
    Samples(std::span<const Sample> kept) : kept_(kept.data()), size_(kept.size()) {}
    Samples(const std::vector<Sample>& kept) : Samples(std::span(kept)) {}
    Samples(const SampleSource& source) : source_(&source), size_(source.size()) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    Sample operator[](std::size_t index) const { return source_ ? source_->at(begin_ + index) : kept_[begin_ + index]; }
    Sample front() const { return (*this)[0]; }

    Samples subspan(std::size_t begin, std::size_t size) const
    {
        Samples part = *this;
        part.begin_ += begin;
        part.size_ = size;
        return part;
    }

    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size_}; }

private:
    const SampleSource* source_ = nullptr;
    const Sample* kept_ = nullptr;  ///< without a source
    std::size_t begin_ = 0;
    std::size_t size_ = 0;
};

/// Samples [begin, end).
struct Segment {
    std::size_t begin = 0;
    std::size_t end = 0;

    std::size_t size() const { return end - begin; }
};

}  // namespace quorient::calibration
