#pragma once

#include "json_output.hpp"
#include "quorient/fdi/detector.hpp"

namespace quorient::cli {

/// A method's figure as JSON; what does not exist is null.
Json json_of(const fdi::Detail::Value& value);

}  // namespace quorient::cli
