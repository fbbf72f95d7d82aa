#pragma once

#include "quorient/security/authority.hpp"

#include <map>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::security {

/// An authority's record: authority/identities.json.
struct Record {
    std::uint32_t domain = 0;
    bus::SecurityLevel level = bus::SecurityLevel::encrypt;
    std::vector<IssuedIdentity> identities;
    std::map<std::string, std::vector<std::string>> serials;  ///< for each name: all certificates that it ever had
    std::vector<std::string> revoked_serials;
};

std::string to_text(const Record& record);
tl::expected<Record, std::string> record_from(const std::string& text);

}  // namespace quorient::security
