#pragma once

#include "quorient/recording/reader.hpp"

namespace quorient::recording {

/// Adds the counts of another log, or of another part; not its duration, since logs may overlap and parts leave gaps between them.
inline void add(Statistics& total, const Statistics& other)
{
    total.records += other.records;
    total.frames += other.frames;
    total.checksum_failures += other.checksum_failures;
    total.malformed += other.malformed;
    total.lost += other.lost;
    total.nan += other.nan;
    total.incomplete += other.incomplete;
    total.repeated += other.repeated;
    total.irregular += other.irregular;
    total.skipped_bytes += other.skipped_bytes;
    total.truncated_bytes += other.truncated_bytes;
}

}  // namespace quorient::recording
