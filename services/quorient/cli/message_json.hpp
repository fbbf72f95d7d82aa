#pragma once

#include "json_output.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/fields.hpp"
#include "quorient/messages/name.hpp"

#include <type_traits>

namespace quorient::cli {

namespace detail {

template <class Value>
Json value_json(const Value& value)
{
    return value;
}

template <std::size_t Size>
Json value_json(const std::array<char, Size>& name)
{
    return std::string{text_of(name)};
}

template <class Element, std::size_t Size>
Json value_json(const std::array<Element, Size>& list)
{
    Json json = Json::array();
    for (const auto& element : list) json.push_back(value_json(element));
    return json;
}

/// The first contaminated frame of each axis: null for one that is not excluded.
inline Json value_json(const Exclusions& excluded_from)
{
    Json json = Json::array();
    for (const auto sequence : excluded_from) json.push_back(sequence == never ? Json(nullptr) : Json(sequence));
    return json;
}

}  // namespace detail

/// Every member of a message under its IDL name; padding is left out.
template <class Message>
Json message_json(const Message& message)
{
    Json json;
    for_each_field(message, [&](const char* name, const auto& value) {
        if (std::string_view{name} != "padding") json[name] = detail::value_json(value);
    });
    return json;
}

}  // namespace quorient::cli
