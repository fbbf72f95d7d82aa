#pragma once

#include <cstdio>
#include <memory>

namespace quorient::cli {

struct FileClosed {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using TemporaryFile = std::unique_ptr<std::FILE, FileClosed>;

/// A file without a name, in $TMPDIR or /var/tmp: /tmp may be memory. It goes with the process. @returns null where there is no room.
TemporaryFile temporary_file();

}  // namespace quorient::cli
