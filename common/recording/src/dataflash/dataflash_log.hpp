#pragma once

#include "batches.hpp"
#include "bytes/input.hpp"
#include "imu_messages.hpp"
#include "line_source.hpp"

namespace quorient::recording::dataflash {

/// Whether these first bytes of a file are a binary DataFlash log: an FMT record, and another record behind it.
bool is_binary(Bytes beginning);

/// Whether these first bytes are the text form: a line "FMT, 128, 89, FMT, …" among the first.
bool is_text(Bytes beginning);

/// The binary form: records of 0xA3 0x95, a type and fields as the FMT records of the log itself describe them.
class BinaryLog final : public InstrumentLog {
public:
    BinaryLog(Input input, std::string name);

    ReadOutcome next(InstrumentSample& sample) override;
    double progress() const override { return input_.progress(); }

private:
    enum class Meaning { other, format, units_of_format, unit, multiplier, imu, batch_head, batch_data };

    /// What is known of one type of records.
    struct Type {
        std::optional<RecordFormat> format;
        Meaning meaning = Meaning::other;
        std::optional<ImuMessage> imu;                             // until units or format change
        std::array<std::optional<std::size_t>, 16> instrument{};  // by instance
    };

    ReadOutcome resynchronise();
    ReadOutcome end_of(std::size_t left);
    ReadOutcome refuse(std::string_view why);
    bool known_start(Bytes bytes) const;
    void understand(Type& type, Bytes record);
    std::optional<ReadOutcome> read_imu(Type& type, Bytes record, InstrumentSample& sample);
    std::optional<ReadOutcome> give_batch(InstrumentSample& sample);
    std::optional<std::size_t> instrument_of(Type& type, std::optional<double> instance);
    void read_format(Bytes record);
    void read_units(Bytes record, const RecordFormat& format);
    void read_unit(Bytes record, const RecordFormat& format);
    void forget_recipes();

    Input input_;
    std::string name_;
    std::array<Type, 256> types_;
    Units units_;
    Batches batches_;
    std::uint64_t record_ = 0;  // offset of the record in hand
    bool ended_ = false;
};

/// The text form, as ground stations write it: "IMU, 208659484, 0.0053, …", with FMT lines that name the fields.
class TextLog final : public InstrumentLog {
public:
    TextLog(Input input, std::string name);

    ReadOutcome next(InstrumentSample& sample) override;
    double progress() const override { return lines_.progress(); }

private:
    struct Message {
        ImuMessage fields;
        std::size_t needed = 0;  // cells of a complete line, its name included
        StampKind stamps = StampKind::arrival;
    };

    std::optional<ReadOutcome> read(std::span<const std::string_view> cells, InstrumentSample& sample);
    void read_format(std::span<const std::string_view> cells);
    ReadOutcome refuse(std::string_view why);

    LineSource lines_;
    std::string name_;
    std::map<std::string, Message, std::less<>> messages_;
    bool ended_ = false;
};

}  // namespace quorient::recording::dataflash
