#pragma once

#include "byte_source.hpp"

namespace quorient::recording {

/// A byte source through one buffer: look at what comes, then take it.
class Input {
public:
    explicit Input(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

    /// The next bytes: at least `count` of them, unless the source ends before. Valid until the next call.
    Bytes peek(std::size_t count);

    /// Takes bytes that the last peek() gave.
    void take(std::size_t count);

    /// Takes this many bytes without looking. @returns how many there were.
    std::uint64_t skip(std::uint64_t count);

    /// Place of the first byte that is not taken.
    std::uint64_t offset() const { return offset_; }

    void rewind();
    double progress() const { return source_->progress(); }
    const std::string& trouble() const { return source_->trouble(); }

private:
    std::unique_ptr<ByteSource> source_;
    std::vector<std::uint8_t> buffer_;
    std::size_t begin_ = 0;  // start of what is not taken
    std::size_t end_ = 0;
    std::uint64_t offset_ = 0;
};

}  // namespace quorient::recording
