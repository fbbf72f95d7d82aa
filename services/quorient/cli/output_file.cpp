#include "output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace quorient::cli {

namespace {

namespace fs = std::filesystem;

std::string system_error_text()
{
    return errno != 0 ? std::strerror(errno) : "cannot be written";
}

void refuse_where_it_cannot_be(const fs::path& file, bool force)
{
    std::error_code unknown;
    const auto status = fs::status(file, unknown);
    if (fs::is_directory(status)) fail(fmt::format("{}: is a directory, expected a file's name", file.string()));
    if (fs::is_regular_file(status) && !force) fail(fmt::format("{}: exists already; --force overwrites it", file.string()));
    const auto folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, unknown)) fail(fmt::format("{}: there is no folder '{}'", file.string(), folder.string()));
    errno = 0;
    if (::access(fs::exists(status) ? file.c_str() : folder.c_str(), W_OK) != 0)
        fail(fmt::format("{}: cannot be written: {}", file.string(), system_error_text()));
}

/// A full disk or a quota may show only when the system writes for good. What is no file on a disk (a pipe) has nothing to wait for.
bool is_on_disk(const std::string& name)
{
    const int file = ::open(name.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) return false;
    const bool done = ::fsync(file) == 0 || errno == EINVAL || errno == EROFS;
    return ::close(file) == 0 && done;
}

}  // namespace

OutputFile::OutputFile(std::string name, bool force) : name_(std::move(name))
{
    refuse_where_it_cannot_be(name_, force);
}

std::ostream& OutputFile::stream()
{
    if (stream_.is_open() || !failure_.empty()) return stream_;
    stream_.rdbuf()->pubsetbuf(nullptr, 0);
    errno = 0;
    stream_.open(name_, std::ios::binary);
    if (!stream_) failure_ = system_error_text();
    errno = 0;
    return stream_;
}

const std::string& OutputFile::failure()
{
    if (failure_.empty() && stream_.is_open() && !stream_) failure_ = system_error_text();
    return failure_;
}

std::uint64_t OutputFile::keep_whole_lines()
{
    stream_.close();
    std::error_code unknown;
    if (!fs::is_regular_file(name_, unknown)) return 0;
    std::ifstream written(name_, std::ios::binary);
    std::uint64_t lines = 0, size = 0, whole = 0;
    std::array<char, 65536> block;
    while (written.read(block.data(), block.size()) || written.gcount() > 0) {
        for (std::streamsize i = 0; i < written.gcount(); ++i) {
            ++size;
            if (block[static_cast<std::size_t>(i)] != '\n') continue;
            ++lines;
            whole = size;
        }
    }
    if (whole < size) fs::resize_file(name_, whole, unknown);
    return lines;
}

void OutputFile::keep_first(std::uint64_t bytes)
{
    stream_.close();
    std::error_code unknown;
    if (fs::is_regular_file(name_, unknown) && fs::file_size(name_, unknown) > bytes) fs::resize_file(name_, bytes, unknown);
}

bool OutputFile::is_complete()
{
    if (failure().empty() && stream_.is_open()) {
        errno = 0;
        stream_.close();
        std::error_code unknown;
        if (!stream_ || (fs::is_regular_file(name_, unknown) && !is_on_disk(name_))) failure_ = system_error_text();
    }
    return failure_.empty();
}

void OutputFile::finish()
{
    if (!is_complete()) fail(fmt::format("{}: {}", name_, failure_));
}

void OutputFile::finish_document()
{
    if (is_complete()) return;
    stream_.close();
    std::error_code unknown;
    if (fs::is_regular_file(name_, unknown)) fs::remove(name_, unknown);
    fail(fmt::format("{}: {}; it is not written", name_, failure_));
}

void OutputFile::finish_rows()
{
    if (is_complete()) return;
    const auto lines = keep_whole_lines();
    fail(fmt::format("{}: {}; {} whole {} in it", name_, failure_, lines, lines == 1 ? "line is" : "lines are"));
}

void refuse_shared_names(const std::vector<std::string>& inputs, std::initializer_list<std::string> outputs)
{
    std::vector<std::string> names = inputs;
    for (const std::string& output : outputs) {
        if (output.empty()) continue;
        for (const std::string& name : names) {
            std::error_code unknown;
            if (output == name || fs::equivalent(output, name, unknown)) fail(fmt::format("{}: is named twice, as an output and otherwise", output));
        }
        names.push_back(output);
    }
}

void add_force(Verb& verb, bool& force)
{
    verb.flag("--force", force, "Overwrite a file that exists already");
}

}  // namespace quorient::cli
