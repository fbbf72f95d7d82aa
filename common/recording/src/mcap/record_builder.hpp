#pragma once

#include "records.hpp"

#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

namespace quorient::recording::mcap {

/// Bytes of records, one after the other: the inverse of the parsers in records.hpp.
class RecordBuilder {
public:
    /// Begins a record; end() fills in its length.
    RecordBuilder& begin(Opcode opcode)
    {
        number(static_cast<std::uint8_t>(opcode));
        return begin_sized<std::uint64_t>();
    }

    /// Begins a list, which is preceded by its size in bytes.
    RecordBuilder& begin_list() { return begin_sized<std::uint32_t>(); }

    RecordBuilder& end() { return end_sized<std::uint64_t>(); }
    RecordBuilder& end_list() { return end_sized<std::uint32_t>(); }

    template <class Number>
    RecordBuilder& number(Number value)
    {
        static_assert(std::is_arithmetic_v<Number>);
        std::array<std::uint8_t, sizeof value> image;
        std::memcpy(image.data(), &value, sizeof value);
        return raw(image);
    }

    RecordBuilder& text(std::string_view value)
    {
        number(static_cast<std::uint32_t>(value.size()));
        return raw({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
    }

    RecordBuilder& raw(Bytes value)
    {
        bytes_.insert(bytes_.end(), value.begin(), value.end());
        return *this;
    }

    Bytes bytes() const { return bytes_; }
    std::size_t size() const { return bytes_.size(); }
    void clear() { bytes_.clear(); }

private:
    template <class Size>
    RecordBuilder& begin_sized()
    {
        number(Size{0});
        open_.push_back(bytes_.size());
        return *this;
    }

    template <class Size>
    RecordBuilder& end_sized()
    {
        const auto size = static_cast<Size>(bytes_.size() - open_.back());
        std::memcpy(bytes_.data() + open_.back() - sizeof size, &size, sizeof size);
        open_.pop_back();
        return *this;
    }

    std::vector<std::uint8_t> bytes_;
    std::vector<std::size_t> open_;  // where the content of what is begun starts
};

}  // namespace quorient::recording::mcap
