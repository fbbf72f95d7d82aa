#include "record_stream.hpp"

#include "bytes/little_endian.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <limits>

namespace quorient::recording::mcap {
namespace {

constexpr std::uint64_t largest_chunk = std::uint64_t{96} << 20U;  // uncompressed; writers make them of 1 to 4 MiB
constexpr std::uint64_t largest_record = std::uint64_t{1} << 20U;  // that is looked at; others (images) are passed over
constexpr std::uint8_t first_private_opcode = 0x80;  // and above: records of applications, to be passed over
constexpr std::size_t read_at_once = std::size_t{1} << 20U;

/// The next bytes of an input, as a source of their own.
class Part final : public ByteSource {
public:
    Part(Input& whole, std::uint64_t size) : whole_(whole), left_(size) {}

    std::size_t read(std::span<std::uint8_t> into) override
    {
        std::size_t count = 0;
        while (count < into.size() && left_ > 0) {
            const Bytes there = whole_.peek(1);
            const std::size_t taken =
                std::min({there.size(), into.size() - count, static_cast<std::size_t>(std::min<std::uint64_t>(left_, SIZE_MAX))});
            if (taken == 0) break;
            std::copy_n(there.begin(), taken, into.begin() + static_cast<std::ptrdiff_t>(count));
            whole_.take(taken);
            count += taken;
            left_ -= taken;
        }
        return count;
    }

    void rewind() override {}  // never called: a part is read once
    double progress() const override { return whole_.progress(); }

private:
    Input& whole_;
    std::uint64_t left_;
};

bool is_known(Opcode opcode)
{
    return opcode >= Opcode::header && opcode <= Opcode::data_end;
}

bool is_known_compression(const std::string& name)
{
    return name.empty() || name == "zstd" || name == "lz4";
}

}  // namespace

bool is_mcap(Bytes beginning)
{
    return beginning.size() >= magic.size() && std::equal(magic.begin(), magic.end(), beginning.begin());
}

RecordStream::RecordStream(Input input, Statistics& counts) : input_(std::move(input)), counts_(counts)
{
    begin();
}

void RecordStream::begin()
{
    if (is_mcap(input_.peek(magic.size()))) input_.take(magic.size());
}

void RecordStream::rewind()
{
    input_.rewind();
    content_ = {};
    held_ = chunk_at_ = 0;
    chunk_.clear();
    ended_ = ended_in_order_ = false;
    begin();
}

Input RecordStream::release()
{
    input_.rewind();
    return std::move(input_);
}

RecordStream::Step RecordStream::next()
{
    input_.take(std::exchange(held_, 0));
    for (;;) {
        const auto step = chunk_at_ < chunk_.size() ? next_in_chunk() : next_in_file();
        if (step) return *step;
    }
}

/// One record of the chunk in hand.
std::optional<RecordStream::Step> RecordStream::next_in_chunk()
{
    const Bytes left = Bytes(chunk_).subspan(chunk_at_);
    const std::uint64_t length = left.size() < record_header_size ? left.size() : little_endian<std::uint64_t>(left, 1);
    if (left.size() < record_header_size || left.size() - record_header_size < length) {
        counts_.truncated_bytes += left.size();
        chunk_at_ = chunk_.size();
        return refuse(fmt::format("the chunk ends {} bytes into a record", left.size()));
    }
    chunk_at_ += record_header_size + static_cast<std::size_t>(length);
    return give(static_cast<Opcode>(left[0]), left.subspan(record_header_size, static_cast<std::size_t>(length)));
}

/// One record of the file itself; nothing if it is passed over.
std::optional<RecordStream::Step> RecordStream::next_in_file()
{
    Bytes bytes = input_.peek(record_header_size);
    position_ = input_.offset();
    if (bytes.size() < record_header_size) return end_of(bytes.size());
    const auto opcode = static_cast<Opcode>(bytes[0]);
    const auto length = little_endian<std::uint64_t>(bytes, 1);
    if (opcode == Opcode::footer || opcode == Opcode::data_end) {
        while (input_.skip(read_at_once) > 0) continue;  // the summary repeats what was read
        ended_ = ended_in_order_ = true;
        return Step::end;
    }
    if (bytes[0] >= first_private_opcode) {
        input_.take(record_header_size);
        const std::uint64_t passed = input_.skip(length);
        return passed < length ? std::optional(end_of(passed)) : std::nullopt;
    }
    if (!is_known(opcode)) {
        ++counts_.records;
        ++counts_.malformed;
        counts_.skipped_bytes += input_.skip(std::numeric_limits<std::uint64_t>::max());
        ended_ = ended_in_order_ = true;
        return refuse(fmt::format("no known record starts here; the {} bytes behind it are not read", counts_.skipped_bytes));
    }
    if (opcode == Opcode::chunk) return open_chunk(length);
    if (length > largest_record) {
        input_.take(record_header_size);
        const std::uint64_t passed = input_.skip(length);
        return passed < length ? std::optional(end_of(passed)) : std::nullopt;
    }
    const auto size = record_header_size + static_cast<std::size_t>(length);
    bytes = input_.peek(size);
    if (bytes.size() < size) return end_of(bytes.size());
    held_ = size;
    return give(opcode, bytes.subspan(record_header_size, size - record_header_size));
}

/// Decompresses a chunk and checks it. A chunk that was cut is kept as far as it goes.
std::optional<RecordStream::Step> RecordStream::open_chunk(std::uint64_t length)
{
    const Bytes beginning = input_.peek(record_header_size + chunk_fields_size({}) + longest_compression);
    const auto fields = parse_chunk_fields(beginning.subspan(record_header_size));
    const bool sound = fields && chunk_fields_size(*fields) <= length && fields->records_size <= length - chunk_fields_size(*fields);
    if (!sound || fields->uncompressed_size > largest_chunk) {
        ++counts_.records;
        ++counts_.malformed;
        input_.take(record_header_size);
        counts_.skipped_bytes += input_.skip(length);
        return refuse(sound ? fmt::format("a chunk of {} MB is too large", fields->uncompressed_size >> 20U)
                            : std::string("a chunk whose fields contradict its length"));
    }
    const std::uint64_t end = input_.offset() + record_header_size + length;
    input_.take(record_header_size + chunk_fields_size(*fields));
    fill_chunk(*fields);
    input_.skip(end - input_.offset());
    return judge_chunk(*fields);
}

void RecordStream::fill_chunk(const Chunk& fields)
{
    std::unique_ptr<ByteSource> records = std::make_unique<Part>(input_, fields.records_size);
    if (fields.compression == "zstd") records = zstd_source(std::move(records));
    else if (fields.compression == "lz4") records = lz4_source(std::move(records));
    chunk_.clear();
    chunk_at_ = 0;
    while (chunk_.size() < fields.uncompressed_size) {
        const std::size_t begin = chunk_.size();
        chunk_.resize(std::min<std::size_t>(begin + read_at_once, static_cast<std::size_t>(fields.uncompressed_size)));
        const std::size_t count = records->read(std::span(chunk_).subspan(begin));
        chunk_.resize(begin + count);
        if (count == 0) break;
    }
}

std::optional<RecordStream::Step> RecordStream::judge_chunk(const Chunk& fields)
{
    const bool cut = chunk_.size() < fields.uncompressed_size;
    const bool unknown = !is_known_compression(fields.compression);
    const bool broken = !cut && fields.uncompressed_crc != 0 && crc32(chunk_) != fields.uncompressed_crc;
    if (!unknown && !broken && !cut) return std::nullopt;
    ++counts_.records;
    ++(broken ? counts_.checksum_failures : counts_.malformed);
    if (unknown || broken) chunk_.clear();
    met_unknown_compression_ = met_unknown_compression_ || unknown;
    if (unknown) return refuse(fmt::format("a chunk compressed by '{}', which is not known", fields.compression));
    if (broken) return refuse("a chunk whose checksum is wrong: its messages are left out");
    return refuse(fmt::format("a chunk is cut: {} of {} bytes are read", chunk_.size(), fields.uncompressed_size));
}

RecordStream::Step RecordStream::give(Opcode opcode, Bytes content)
{
    opcode_ = opcode;
    content_ = content;
    return Step::record;
}

RecordStream::Step RecordStream::end_of(std::uint64_t left)
{
    input_.take(input_.peek(1).size());
    if (ended_) return Step::end;
    ended_ = true;
    counts_.truncated_bytes += left;
    if (!input_.trouble().empty()) return refuse(input_.trouble());
    return left > 0 ? refuse(fmt::format("the log ends {} bytes into a record", left)) : Step::end;
}

RecordStream::Step RecordStream::refuse(std::string why)
{
    problem_ = std::move(why);
    return Step::refused;
}

}  // namespace quorient::recording::mcap
