#pragma once

#include "bytes/input.hpp"

namespace quorient::recording {

/// A file's bytes, decompressed where it is compressed.
inline tl::expected<Input, std::string> open_input(const std::filesystem::path& file)
{
    auto source = file_source(file);
    if (!source) return tl::unexpected(source.error());
    return Input(decompressed(std::move(*source)));
}

}  // namespace quorient::recording
