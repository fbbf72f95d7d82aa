#include "quorient/recording/instrument_log.hpp"

#include "csv/csv_log.hpp"
#include "dataflash/dataflash_log.hpp"
#include "formats.hpp"
#include "frame_instruments.hpp"
#include "mcap/mcap_log.hpp"
#include "ros/bag_directory.hpp"
#include "ros/sqlite_bag.hpp"
#include "ulog/ulog_log.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::recording {
namespace {

using OpenedInstruments = tl::expected<std::unique_ptr<InstrumentLog>, std::string>;

constexpr std::string_view sqlite_magic = "SQLite format 3";

bool is_sqlite(Bytes beginning)
{
    return std::equal(sqlite_magic.begin(), sqlite_magic.end(), beginning.begin(),
                      beginning.begin() + static_cast<std::ptrdiff_t>(std::min(beginning.size(), sqlite_magic.size())));
}

OpenedInstruments open_mcap(Input input, const std::string& name)
{
    auto record = mcap::FrameReader::open(input, name);
    if (!record) return std::make_unique<mcap::McapLog>(std::move(input), name);
    if (!*record) return tl::unexpected(record->error());
    return frame_instruments(std::move(**record), name);
}

OpenedInstruments open_kind(Kind kind, Input input, const std::string& name, const LogOptions& options, std::size_t sniffed)
{
    switch (kind) {
        case Kind::mimu4444: return frame_instruments(std::make_unique<MimuReader>(std::move(input), name), "MIMU4444");
        case Kind::dataflash: return std::make_unique<dataflash::BinaryLog>(std::move(input), name);
        case Kind::dataflash_text: return std::make_unique<dataflash::TextLog>(std::move(input), name);
        case Kind::mcap: return open_mcap(std::move(input), name);
        case Kind::ulog: return ulog::UlogLog::open(std::move(input), name);
        case Kind::text: return csv::CsvLog::open(std::move(input), name, options);
        default: return tl::unexpected(fmt::format("{}: byte 0: {}", name, why_not(kind, sniffed)));
    }
}

OpenedInstruments open_source(std::unique_ptr<ByteSource> source, const std::string& name, const LogOptions& options)
{
    Input input(decompressed(std::move(source)));
    const Bytes beginning = input.peek(sniffed_bytes).first(std::min(sniffed_bytes, input.peek(sniffed_bytes).size()));
    if (beginning.empty() && !input.trouble().empty()) return tl::unexpected(fmt::format("{}: {}", name, input.trouble()));
    const Kind kind = kind_of(beginning);
    const std::size_t sniffed = beginning.size();
    return open_kind(kind, std::move(input), name, options, sniffed);
}

}  // namespace

std::optional<std::size_t> InstrumentLog::place_of(const Instrument& instrument)
{
    const auto same = [&](const Instrument& known) { return known.name == instrument.name && known.source == instrument.source; };
    const auto found = std::find_if(instruments_.begin(), instruments_.end(), same);
    if (found != instruments_.end()) return static_cast<std::size_t>(found - instruments_.begin());
    if (instruments_.size() >= max_instruments) return std::nullopt;
    instruments_.push_back(instrument);
    return instruments_.size() - 1;
}

OpenedInstruments open_instruments(const std::filesystem::path& file, const LogOptions& options)
{
    if (std::filesystem::is_directory(file)) return ros::open_bag_directory(file);
    auto source = file_source(file);
    if (!source) return tl::unexpected(source.error());
    std::array<std::uint8_t, sqlite_magic.size()> beginning{};
    const std::size_t count = (*source)->read(beginning);
    (*source)->rewind();
    if (is_sqlite(Bytes(beginning).first(count))) return ros::SqliteBag::open(file);
    return open_source(std::move(*source), file.filename().string(), options);
}

OpenedInstruments open_instruments(std::vector<std::uint8_t> bytes, const std::string& name, const LogOptions& options)
{
    if (is_sqlite(bytes)) return ros::SqliteBag::open(std::move(bytes), name);
    return open_source(memory_source(std::move(bytes)), name, options);
}

}  // namespace quorient::recording
