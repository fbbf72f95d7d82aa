#include "quorient/recording/reader.hpp"

#include <fmt/format.h>

namespace quorient::recording {

std::string summary(const Statistics& statistics)
{
    std::string line = fmt::format("{} records, {} frames, {:.1f} s", statistics.records, statistics.frames,
                                   static_cast<double>(statistics.duration_ns) * 1e-9);
    const auto add = [&](std::uint64_t count, std::string_view what) {
        if (count > 0) line += fmt::format(", {} {}", count, what);
    };
    add(statistics.checksum_failures, "checksum failures");
    add(statistics.malformed, "malformed");
    add(statistics.lost, "lost");
    add(statistics.nan, "not finite");
    add(statistics.incomplete, "incomplete");
    add(statistics.repeated, "repeated");
    add(statistics.irregular, "irregular in time");
    add(statistics.skipped_bytes, "bytes passed over");
    add(statistics.truncated_bytes, "bytes of a cut record at the end");
    return line;
}

}  // namespace quorient::recording
