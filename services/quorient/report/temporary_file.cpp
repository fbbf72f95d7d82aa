#include "report/temporary_file.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <cstdlib>

namespace quorient::cli {

TemporaryFile temporary_file()
{
    const char* chosen = std::getenv("TMPDIR");
    const int file = ::open(chosen && *chosen ? chosen : "/var/tmp", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    return TemporaryFile(file < 0 ? std::tmpfile() : ::fdopen(file, "w+"));
}

}  // namespace quorient::cli
