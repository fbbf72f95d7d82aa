#pragma once

#include "bytes/byte_source.hpp"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::recording::ulog {

enum class NumberType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64, none };

/// Where a field of a message lies, and as what.
struct Field {
    std::size_t offset = 0;
    NumberType type = NumberType::none;
    std::size_t count = 1;  ///< elements of an array

    bool is_float() const { return type == NumberType::float32 || type == NumberType::float64; }
};

/// An element of a field; nothing where the message ends before it (padding behind the last field is not logged).
std::optional<double> number_at(Bytes message, const Field& field, std::size_t element = 0);

/// An identity: nothing where the field is none of integers.
std::optional<std::uint64_t> integer_at(Bytes message, const Field& field);

/// What the F messages of a log say of its message types.
class Definitions {
public:
    /// Takes "name:type field;type[3] field;…". @returns false if the text is none of that kind.
    bool add(std::string_view text);

    bool has(std::string_view message) const { return members_.find(message) != members_.end(); }

    /// Where a field of a message lies. Nothing: no such message or field, or one before it is of an unknown type.
    std::optional<Field> field(std::string_view message, std::string_view name) const;

private:
    struct Member {
        std::string type;
        std::string name;
        std::size_t count = 1;
    };

    /// Bytes of one element; nothing for an unknown type, or types within themselves.
    std::optional<std::size_t> size_of(std::string_view type, int depth) const;

    std::map<std::string, std::vector<Member>, std::less<>> members_;
};

}  // namespace quorient::recording::ulog
