#include "dataflash_log.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::recording::dataflash {

bool is_binary(Bytes beginning)
{
    const auto starts = [&](std::size_t at) {
        return beginning.size() >= at + header_size && beginning[at] == record_start[0] && beginning[at + 1] == record_start[1];
    };
    return starts(0) && beginning[2] == format_type && starts(format_length);
}

BinaryLog::BinaryLog(Input input, std::string name) : input_(std::move(input)), name_(std::move(name))
{
    format_ = "ArduPilot DataFlash";
    types_[format_type].format = format_of_formats();
    types_[format_type].meaning = Meaning::format;
}

ReadOutcome BinaryLog::next(InstrumentSample& sample)
{
    for (;;) {
        if (const auto outcome = give_batch(sample)) return *outcome;
        Bytes bytes = input_.peek(header_size);
        record_ = input_.offset();
        if (bytes.size() < header_size) return end_of(bytes.size());
        if (!known_start(bytes)) return resynchronise();
        Type& type = types_[bytes[2]];
        const std::size_t length = type.format->length;
        bytes = input_.peek(length);
        if (bytes.size() < length) return end_of(bytes.size());
        std::optional<ReadOutcome> outcome;
        if (type.meaning == Meaning::imu) outcome = read_imu(type, bytes.first(length), sample);
        else understand(type, bytes.first(length));
        input_.take(length);
        if (outcome) return *outcome;
    }
}

bool BinaryLog::known_start(Bytes bytes) const
{
    return bytes[0] == record_start[0] && bytes[1] == record_start[1] && types_[bytes[2]].format;
}

ReadOutcome BinaryLog::refuse(std::string_view why)
{
    problem_ = fmt::format("{}: byte {}: {}", name_, record_, why);
    return ReadOutcome::rejected;
}

/// Passes over what is no record to the next one of a known type.
ReadOutcome BinaryLog::resynchronise()
{
    ++statistics_.records;
    ++statistics_.malformed;
    input_.take(1);
    for (Bytes bytes = input_.peek(header_size); bytes.size() >= header_size; bytes = input_.peek(header_size)) {
        const auto start = std::find(bytes.begin(), bytes.end() - (header_size - 1), record_start[0]);
        const auto passed = static_cast<std::size_t>(start - bytes.begin());
        input_.take(passed);
        if (passed + header_size > bytes.size()) continue;
        if (known_start(bytes.subspan(passed))) break;
        input_.take(1);
    }
    if (input_.peek(header_size).size() < header_size) input_.take(input_.peek(header_size).size());
    const std::uint64_t passed = input_.offset() - record_;
    statistics_.skipped_bytes += passed;
    return refuse(fmt::format("no record of a known type starts here; {} bytes passed over", passed));
}

ReadOutcome BinaryLog::end_of(std::size_t left)
{
    if (ended_) return ReadOutcome::end;
    ended_ = true;
    input_.take(left);
    statistics_.truncated_bytes = left;
    if (!input_.trouble().empty()) return refuse(input_.trouble());
    if (left > 0) return refuse(fmt::format("the log ends {} bytes into a record", left));
    return ReadOutcome::end;
}

/// Records that say how others are to be read, and the beginnings of batches.
void BinaryLog::understand(Type& type, Bytes record)
{
    switch (type.meaning) {
        case Meaning::format: read_format(record); break;
        case Meaning::units_of_format: read_units(record, *type.format); break;
        case Meaning::unit:
        case Meaning::multiplier: read_unit(record, *type.format); break;
        case Meaning::batch_head: batches_.head(record, *type.format); break;
        case Meaning::batch_data: batches_.data(record, *type.format); break;
        case Meaning::imu:
        case Meaning::other: break;
    }
}

void BinaryLog::read_format(Bytes record)
{
    static const RecordFormat own = format_of_formats();
    const std::uint8_t code = record[own.fields[0].offset];
    const std::size_t length = record[own.fields[1].offset];
    const std::string name(text_at(record, own.fields[2]));
    if (code == format_type || length < header_size) return;
    auto format = make_format(code, length, name, text_at(record, own.fields[3]), text_at(record, own.fields[4]));
    Type type;
    if (format.consistent) {
        if (name == "FMTU") type.meaning = Meaning::units_of_format;
        else if (name == "UNIT") type.meaning = Meaning::unit;
        else if (name == "MULT") type.meaning = Meaning::multiplier;
        else if (name == "ISBH") type.meaning = Meaning::batch_head;
        else if (name == "ISBD") type.meaning = Meaning::batch_data;
        else if (is_imu_name(name)) type.meaning = Meaning::imu;
    } else if (is_imu_name(name)) {
        remarks_.push_back(fmt::format("{} is not read: its fields do not fill its length of {} bytes", name, length));
    }
    type.format = std::move(format);
    types_[code] = std::move(type);
}

void BinaryLog::read_units(Bytes record, const RecordFormat& format)
{
    const auto code = format.place("FmtType");
    const auto units = format.place("UnitIds");
    const auto multipliers = format.place("MultIds");
    if (!code || !units || !multipliers) return;
    auto& described = types_[static_cast<std::uint8_t>(number_at(record, format.fields[*code]))].format;
    if (!described) return;
    const std::string_view unit = text_at(record, format.fields[*units]);
    const std::string_view multiplier = text_at(record, format.fields[*multipliers]);
    for (std::size_t i = 0; i < described->fields.size(); ++i) {
        if (i < unit.size()) described->fields[i].unit = unit[i];
        if (i < multiplier.size()) described->fields[i].multiplier = multiplier[i];
    }
    forget_recipes();
}

void BinaryLog::read_unit(Bytes record, const RecordFormat& format)
{
    const auto id = format.place("Id");
    const auto label = format.place("Label");
    const auto factor = format.place("Mult");
    if (!id) return;
    const char letter = static_cast<char>(number_at(record, format.fields[*id]));
    if (label) units_.label[letter] = text_at(record, format.fields[*label]);
    if (factor) units_.multiplier[letter] = number_at(record, format.fields[*factor]);
    forget_recipes();
}

void BinaryLog::forget_recipes()
{
    for (Type& type : types_) type.imu.reset();
}

std::optional<ReadOutcome> BinaryLog::read_imu(Type& type, Bytes record, InstrumentSample& sample)
{
    if (!type.imu) type.imu = imu_message(*type.format, units_);
    if (!type.imu) {
        remarks_.push_back(fmt::format("{} is not read: it has no time or no gyros", type.format->name));
        type.meaning = Meaning::other;
        return std::nullopt;
    }
    ++statistics_.records;
    const auto value = [&](std::size_t place) { return number_at(record, type.format->fields[place]); };
    const auto made = sample_of(*type.imu, value);
    if (!made) {
        ++statistics_.malformed;
        return refuse(fmt::format("{}: its time is none", type.format->name));
    }
    const auto instance = type.imu->instance ? std::optional(value(*type.imu->instance)) : std::nullopt;
    const auto instrument = instrument_of(type, instance);
    if (!instrument) {
        ++statistics_.malformed;
        return refuse(fmt::format("{}: more than {} instruments", type.format->name, max_instruments));
    }
    sample = *made;
    sample.instrument = *instrument;
    sample.position = record_;
    ++statistics_.frames;
    return ReadOutcome::frame;
}

std::optional<std::size_t> BinaryLog::instrument_of(Type& type, std::optional<double> instance)
{
    const auto number = static_cast<std::size_t>(instance.value_or(0));
    if (number < type.instrument.size() && type.instrument[number]) return type.instrument[number];
    Instrument made;
    made.name = instrument_name(type.format->name, instance);
    made.source = source_name(type.format->name);
    made.stamps = type.imu->stamps;
    const auto place = place_of(made);
    if (number < type.instrument.size()) type.instrument[number] = place;
    return place;
}

std::optional<ReadOutcome> BinaryLog::give_batch(InstrumentSample& sample)
{
    BatchSample one;
    if (!batches_.next(one)) return std::nullopt;
    ++statistics_.records;
    Instrument made;
    made.name = instrument_name("ISBD", one.instance);
    made.source = "ISBD";
    made.stamps = StampKind::sampling;
    const auto place = place_of(made);
    const auto time_ns = log_time_ns(one.time_us, 1e3);
    if (!place || !time_ns) {
        ++statistics_.malformed;
        return refuse("ISBD: its time is none, or it belongs to one instrument too many");
    }
    sample = {};
    sample.instrument = *place;
    sample.time_ns = *time_ns;
    sample.rate_rad_s = one.rate_rad_s;
    sample.position = record_;
    ++statistics_.frames;
    return ReadOutcome::frame;
}

}  // namespace quorient::recording::dataflash
