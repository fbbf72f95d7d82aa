#pragma once

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"

#include <string_view>

namespace quorient::cli {

/// The word of a code in a field of this name; empty where the field holds no code.
template <class Message>
std::string_view word_in(const Message& message, std::string_view field)
{
    if constexpr (requires { state_of(message); })
        if (field == "state") return to_string(state_of(message));
    if constexpr (requires { kind_of(message); })
        if (field == "kind") return to_string(kind_of(message));
    if constexpr (requires { mode_of(message); })
        if (field == "mode") return to_string(mode_of(message));
    if constexpr (requires { level_of(message); })
        if (field == "level") return to_string(level_of(message));
    if constexpr (requires { code_of(message); })
        if (field == "code") return to_string(code_of(message));
    if constexpr (requires { severity_of(message); })
        if (field == "severity") return to_string(severity_of(message));
    if constexpr (requires { role_of(message); })
        if (field == "role") return to_string(role_of(message));
    if constexpr (requires { action_of(message); })
        if (field == "action") return to_string(action_of(message));
    return {};
}

}  // namespace quorient::cli
