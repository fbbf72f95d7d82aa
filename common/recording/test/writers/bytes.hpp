#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace quorient::recording::test {

/// Appends values as they lie in memory: numbers lowest byte first, arrays element by element, texts without a zero.
class Bytes {
public:
    template <class Value>
    Bytes& put(const Value& value)
    {
        if constexpr (std::is_convertible_v<Value, std::string>) {
            const std::string text(value);
            data.insert(data.end(), text.begin(), text.end());
        } else {
            for (const auto octet : std::bit_cast<std::array<std::uint8_t, sizeof value>>(value)) data.push_back(octet);
        }
        return *this;
    }

    /// A text of a fixed size, filled up with zeros.
    Bytes& put(const std::string& text, std::size_t size)
    {
        const std::size_t end = data.size() + size;
        put(text.substr(0, size));
        data.resize(end);
        return *this;
    }

    std::vector<std::uint8_t> data;
};

}  // namespace quorient::recording::test
