#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::recording {

/// The bytes of a log from its beginning to its end, whatever holds them: a file, memory, or either of them compressed.
class ByteSource {
public:
    virtual ~ByteSource() = default;
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;

    /// Fills the span from its beginning. Fewer bytes than asked for: the source has ended, or trouble() says why it cannot go on.
    virtual std::size_t read(std::span<std::uint8_t> into) = 0;

    /// Back to the first byte.
    virtual void rewind() = 0;

    /// How much of what is stored (compressed bytes, where they are) has been read, 0 .. 1.
    virtual double progress() const = 0;

    /// Why the bytes ended early; empty while nothing is wrong.
    const std::string& trouble() const { return trouble_; }

protected:
    ByteSource() = default;

    std::string trouble_;
};

using Bytes = std::span<const std::uint8_t>;

/// @returns an error if the file is no regular file or cannot be opened.
tl::expected<std::unique_ptr<ByteSource>, std::string> file_source(const std::filesystem::path& file);
std::unique_ptr<ByteSource> memory_source(std::vector<std::uint8_t> bytes);

/// Each holds a buffer of 64 KiB and its library's window, however long the stream. A stream may have several members or frames.
std::unique_ptr<ByteSource> gzip_source(std::unique_ptr<ByteSource> compressed);
std::unique_ptr<ByteSource> zstd_source(std::unique_ptr<ByteSource> compressed);
std::unique_ptr<ByteSource> lz4_source(std::unique_ptr<ByteSource> compressed);

/// The source itself, or what it holds compressed (.gz, .zst, .lz4 by their first bytes).
std::unique_ptr<ByteSource> decompressed(std::unique_ptr<ByteSource> source);

}  // namespace quorient::recording
