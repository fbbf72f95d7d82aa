#pragma once

#include "mcap_writer.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/recording/mcap_writer.hpp"

#include <random>
#include <sstream>

namespace quorient::recording::test {

inline constexpr std::uint64_t epoch = 1'700'000'000'000'000'000;

template <class Sample>
ByteVector cdr_of(const Sample& sample)
{
    ByteVector cdr{0, 1, 0, 0};
    const auto* const image = reinterpret_cast<const std::uint8_t*>(&sample);
    cdr.insert(cdr.end(), image, image + sizeof sample);
    return cdr;
}

inline ClusterDescription description_of(std::uint8_t axes)
{
    ClusterDescription description;
    description.epoch = epoch;
    description.unit = 1;
    description.revision = 1;
    description.kind = octet(SensorKind::gyro);
    description.axis_count = description.instrument_count = axes;
    for (std::uint8_t axis = 0; axis < axes; ++axis) description.instrument[axis] = axis;
    description.axis[0] = {1, 0, 0};
    description.sigma[2] = 1e-6;
    description.bias[1] = 0.25;
    description.interval_s = 0.005;
    description.initial_attitude_known = octet(InitialAttitude::measured);
    return description;
}

inline SensorFrame frame_of(std::uint64_t sequence)
{
    static std::mt19937_64 random{3};
    SensorFrame frame;
    frame.epoch = epoch;
    frame.sequence = sequence;
    frame.sample_time_ns = 5'000'000 * static_cast<std::int64_t>(sequence + 1) + static_cast<std::int64_t>(sequence % 3);
    frame.interval_s = 0.005 + 1e-12 * static_cast<double>(sequence);
    for (double& increment : frame.increment) increment = std::uniform_real_distribution(-1.0, 1.0)(random);
    frame.unit = 1;
    frame.valid_mask = 0b1111;
    frame.description_revision = 1;
    frame.kind = octet(SensorKind::gyro);
    frame.axis_count = 4;
    return frame;
}

inline TruthState truth_of(const SensorFrame& frame)
{
    TruthState truth;
    truth.epoch = frame.epoch;
    truth.sequence = frame.sequence;
    truth.unit = frame.unit;
    truth.attitude = {0.5, 0.5, 0.5, static_cast<double>(frame.sequence)};
    truth.attitude_known = 1;
    return truth;
}

inline std::vector<SensorFrame> frames_of(std::size_t count)
{
    std::vector<SensorFrame> frames;
    for (std::size_t i = 0; i < count; ++i) frames.push_back(frame_of(i));
    return frames;
}

/// Writes a record as `quorient record` does: all schemas first, samples in chunks.
class Record {
public:
    Record() : writer_(out_, "a test")
    {
        cluster_ = writer_.add_channel("quorient/cluster", "cdr", writer_.add_schema("quorient_msgs::ClusterDescription", "omgidl", "..."));
        frame_ = writer_.add_channel("quorient/frame", "cdr", writer_.add_schema("quorient_msgs::SensorFrame", "omgidl", "..."));
        truth_ = writer_.add_channel("quorient/truth", "cdr", writer_.add_schema("quorient_msgs::TruthState", "omgidl", "..."));
    }

    void add(const ClusterDescription& sample) { writer_.add(cluster_, ++time_, cdr_of(sample)); }
    void add(const SensorFrame& sample) { writer_.add(frame_, ++time_, cdr_of(sample)); }
    void add(const TruthState& sample) { writer_.add(truth_, ++time_, cdr_of(sample)); }
    void add_raw_frame(const ByteVector& cdr) { writer_.add(frame_, ++time_, cdr); }
    void end_chunk() { writer_.end_chunk(); }

    ByteVector finish()
    {
        writer_.finish();
        return bytes();
    }

    ByteVector bytes() const
    {
        const std::string text = out_.str();
        return {text.begin(), text.end()};
    }

    const mcap::Writer& writer() const { return writer_; }

private:
    std::ostringstream out_;
    mcap::Writer writer_;
    std::uint16_t cluster_ = 0, frame_ = 0, truth_ = 0;
    std::uint64_t time_ = 1'700'000'000'000'000'000;
};

inline ByteVector record_of(const std::vector<SensorFrame>& frames, std::size_t chunk = 50)
{
    Record record;
    record.add(description_of(4));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        record.add(frames[i]);
        if (i % chunk == chunk - 1) record.end_chunk();
    }
    return record.finish();
}

}  // namespace quorient::recording::test
