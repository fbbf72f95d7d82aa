#pragma once

#include <cstdlib>
#include <filesystem>

namespace quorient::recording {

/// The folder of recordings: $QUORIENT_DATA_DIR, else the one beside the checkout.
inline std::filesystem::path data_folder(const std::filesystem::path& checkout)
{
    const char* const given = std::getenv("QUORIENT_DATA_DIR");
    return given != nullptr ? std::filesystem::path(given) : checkout / ".." / "shared" / "data";
}

}  // namespace quorient::recording
