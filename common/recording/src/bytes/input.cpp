#include "input.hpp"

#include <algorithm>
#include <cassert>

namespace quorient::recording {
namespace {

constexpr std::size_t usual_size = 1U << 17U;

}  // namespace

Bytes Input::peek(std::size_t count)
{
    if (end_ - begin_ < count) {
        std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
                  buffer_.begin());
        end_ -= begin_;
        begin_ = 0;
        if (buffer_.size() < count || buffer_.empty()) buffer_.resize(std::max(usual_size, 2 * count));
        end_ += source_->read(std::span(buffer_).subspan(end_));
    }
    return Bytes(buffer_).subspan(begin_, end_ - begin_);
}

void Input::take(std::size_t count)
{
    assert(count <= end_ - begin_);
    begin_ += count;
    offset_ += count;
}

std::uint64_t Input::skip(std::uint64_t count)
{
    std::uint64_t left = count;
    while (left > 0) {
        const std::size_t there = std::min<std::uint64_t>(left, peek(1).size());
        if (there == 0) break;
        take(there);
        left -= there;
    }
    return count - left;
}

void Input::rewind()
{
    source_->rewind();
    begin_ = end_ = 0;
    offset_ = 0;
}

}  // namespace quorient::recording
