#pragma once

#include "bytes/input.hpp"
#include "imu_topics.hpp"
#include "stamps.hpp"

#include <deque>
#include <map>

namespace quorient::recording::ulog {

bool is_ulog(Bytes beginning);

/// PX4's ULog: a header, definitions, then data messages of topics that were subscribed to; each topic has instances.
class UlogLog final : public InstrumentLog {
public:
    /// @returns an error if the log's flags ask for something that is not known.
    static tl::expected<std::unique_ptr<InstrumentLog>, std::string> open(Input input, std::string name);

    ReadOutcome next(InstrumentSample& sample) override;
    double progress() const override { return input_.progress(); }

private:
    /// What a message id of the data section stands for.
    struct Subscription {
        std::string topic;
        unsigned instance = 0;
        std::optional<ImuTopic> imu;
        std::optional<FifoTopic> fifo;
        std::optional<Field> selected_device;
        std::optional<Field> status_device;
        std::optional<Field> status_temperature;
        std::optional<std::size_t> place;  // its instrument's
    };

    UlogLog(Input input, std::string name);
    std::optional<std::string> read_flags();
    std::optional<ReadOutcome> message(std::uint8_t type, Bytes content, InstrumentSample& sample);
    void subscribe(Bytes content);
    std::optional<ReadOutcome> data(Bytes content, InstrumentSample& sample);
    ReadOutcome give(Subscription& subscription, InstrumentSample made, std::optional<std::uint64_t> device, InstrumentSample& sample);
    void note_status(const Subscription& subscription, Bytes content);
    void note_dropout(Bytes content);
    void pass_to_appended(std::uint64_t offset);
    ReadOutcome resynchronise();
    ReadOutcome end_of(std::size_t left);
    ReadOutcome refuse(std::string_view why);

    Input input_;
    std::string name_;
    Definitions definitions_;
    std::map<unsigned, Subscription> subscriptions_;
    std::map<std::uint64_t, double> temperature_c_;  // by device, as vehicle_imu_status states it
    std::vector<std::uint64_t> appended_;            // offsets of appended data still to come
    std::vector<InstrumentSample> waiting_;          // samples of the last FIFO message
    std::size_t given_ = 0;                          // how many of those
    Subscription* waiting_for_ = nullptr;            // the FIFO's subscription
    std::optional<std::uint64_t> waiting_device_;
    std::uint64_t record_ = 0;                       // offset of the message in hand
    std::uint64_t dropouts_ = 0;
    std::uint64_t dropout_ms_ = 0;
    std::optional<std::size_t> dropout_remark_;
    bool ended_ = false;
};

}  // namespace quorient::recording::ulog
