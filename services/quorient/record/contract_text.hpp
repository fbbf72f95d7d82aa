#pragma once

#include <string_view>

namespace quorient::record {

/// idl/quorient_msgs.idl, as it was when the program was built.
extern const std::string_view contract_text;

}  // namespace quorient::record
