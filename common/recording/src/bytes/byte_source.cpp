#include "byte_source.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <fstream>

namespace quorient::recording {
namespace {

class FileSource final : public ByteSource {
public:
    FileSource(std::ifstream stream, std::uintmax_t size) : stream_(std::move(stream)), size_(size) {}

    std::size_t read(std::span<std::uint8_t> into) override
    {
        stream_.read(reinterpret_cast<char*>(into.data()), static_cast<std::streamsize>(into.size()));
        const auto count = static_cast<std::size_t>(stream_.gcount());
        if (stream_.bad()) trouble_ = fmt::format("reading failed at byte {}", read_ + count);
        read_ += count;
        return count;
    }

    void rewind() override
    {
        stream_.clear();
        stream_.seekg(0);
        read_ = 0;
        trouble_.clear();
    }

    double progress() const override { return size_ == 0 ? 1.0 : static_cast<double>(read_) / static_cast<double>(size_); }

private:
    std::ifstream stream_;
    std::uintmax_t size_;
    std::uint64_t read_ = 0;
};

class MemorySource final : public ByteSource {
public:
    explicit MemorySource(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

    std::size_t read(std::span<std::uint8_t> into) override
    {
        const std::size_t count = std::min(into.size(), bytes_.size() - read_);
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(read_), count, into.begin());
        read_ += count;
        return count;
    }

    void rewind() override { read_ = 0; }

    double progress() const override { return bytes_.empty() ? 1.0 : static_cast<double>(read_) / static_cast<double>(bytes_.size()); }

private:
    std::vector<std::uint8_t> bytes_;
    std::size_t read_ = 0;
};

}  // namespace

tl::expected<std::unique_ptr<ByteSource>, std::string> file_source(const std::filesystem::path& file)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        return tl::unexpected(fmt::format("{}: {}", file.string(), error ? error.message() : "not a regular file"));
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return tl::unexpected(fmt::format("{}: cannot be opened for reading", file.string()));
    return std::make_unique<FileSource>(std::move(stream), std::filesystem::file_size(file, error));
}

std::unique_ptr<ByteSource> memory_source(std::vector<std::uint8_t> bytes)
{
    return std::make_unique<MemorySource>(std::move(bytes));
}

std::unique_ptr<ByteSource> decompressed(std::unique_ptr<ByteSource> source)
{
    std::array<std::uint8_t, 4> magic{};
    const std::size_t count = source->read(magic);
    source->rewind();
    const auto begins_with = [&](std::initializer_list<std::uint8_t> expected) {
        return count >= expected.size() && std::equal(expected.begin(), expected.end(), magic.begin());
    };
    if (begins_with({0x1F, 0x8B, 0x08})) return gzip_source(std::move(source));
    if (begins_with({0x28, 0xB5, 0x2F, 0xFD})) return zstd_source(std::move(source));
    if (begins_with({0x04, 0x22, 0x4D, 0x18})) return lz4_source(std::move(source));
    return source;
}

}  // namespace quorient::recording
