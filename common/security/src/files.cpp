#include "files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <cstring>

namespace quorient::security {

namespace {

constexpr std::size_t most_megabytes = 16;
constexpr std::size_t most_bytes = most_megabytes << 20U;

/// An open file, closed by the destructor.
class File {
public:
    File(const std::filesystem::path& path, int flags, mode_t mode = 0) : descriptor_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
    ~File()
    {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    bool is_open() const { return descriptor_ >= 0; }

    /// Reads to its end, or a little beyond most_bytes.
    /// @returns false, with errno, if it cannot be read.
    bool read_all(std::string& content) const
    {
        std::array<char, 4096> part{};
        while (content.size() <= most_bytes) {
            const auto got = ::read(descriptor_, part.data(), part.size());
            if (got < 0) return false;
            if (got == 0) return true;
            content.append(part.data(), static_cast<std::size_t>(got));
        }
        return true;
    }

    bool write_all(const std::string& content, mode_t mode) const
    {
        for (std::size_t written = 0; written < content.size();) {
            const auto done = ::write(descriptor_, content.data() + written, content.size() - written);
            if (done < 0) return false;
            written += static_cast<std::size_t>(done);
        }
        return ::fchmod(descriptor_, mode) == 0 && ::fsync(descriptor_) == 0;
    }

private:
    int descriptor_;
};

std::string system_error()
{
    return std::strerror(errno);
}

}  // namespace

tl::expected<std::string, std::string> read_file(const std::filesystem::path& path)
{
    const File file{path, O_RDONLY};
    std::string content;
    if (!file.is_open() || !file.read_all(content)) return tl::make_unexpected(system_error());
    if (content.size() > most_bytes) return tl::make_unexpected(fmt::format("more than {} MB", most_megabytes));
    return content;
}

tl::expected<void, std::string> write_file(const std::filesystem::path& path, const std::string& content, mode_t mode)
{
    auto temporary = path;
    temporary += ".new";
    ::unlink(temporary.c_str());  // left by an interrupted run
    constexpr mode_t owner_alone = 0600;
    const File file{temporary, O_WRONLY | O_CREAT | O_EXCL, owner_alone};
    if (file.is_open() && file.write_all(content, mode) && ::rename(temporary.c_str(), path.c_str()) == 0) return {};
    return tl::make_unexpected(fmt::format("{}: cannot be written: {}", path.string(), system_error()));
}

}  // namespace quorient::security
