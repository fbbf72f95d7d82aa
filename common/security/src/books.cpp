#include "books.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace quorient::security {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const IssuedIdentity& identity)
{
    Json certificates = Json::array();
    for (const auto& [common_name, serial, expires_s] : identity.certificates)
        certificates.push_back({{"common_name", common_name}, {"serial", serial}, {"expires_s", expires_s}});
    const auto& [name, role, access] = identity.member;
    return {{"name", name},
            {"role", to_string(role)},
            {"publishes", access.publishes},
            {"subscribes", access.subscribes},
            {"revoked", identity.revoked},
            {"certificates", certificates}};
}

/// @throws nlohmann::json::exception, or std::runtime_error for an unknown word.
IssuedIdentity identity_from(const Json& json)
{
    const auto role = role_from(json.at("role").get<std::string>());
    if (!role) throw std::runtime_error(role.error());
    IssuedIdentity identity{{json.at("name"), *role, {json.at("publishes"), json.at("subscribes")}}, {}, json.at("revoked")};
    for (const auto& certificate : json.at("certificates"))
        identity.certificates.push_back({certificate.at("common_name"), certificate.at("serial"), certificate.at("expires_s")});
    return identity;
}

}  // namespace

std::string to_text(const Record& record)
{
    Json identities = Json::array();
    for (const auto& identity : record.identities) identities.push_back(json_of(identity));
    const Json json{{"domain", record.domain},
                    {"level", bus::to_string(record.level)},
                    {"identities", identities},
                    {"serials", record.serials},
                    {"revoked", record.revoked_serials}};
    return json.dump(2) + "\n";
}

tl::expected<Record, std::string> record_from(const std::string& text)
{
    try {
        const auto json = Json::parse(text);
        const auto level = bus::security_level_from(json.at("level").get<std::string>());
        if (!level) throw std::runtime_error(level.error());
        Record record{json.at("domain"), *level, {}, json.at("serials"), json.at("revoked")};
        for (const auto& identity : json.at("identities")) record.identities.push_back(identity_from(identity));
        return record;
    } catch (const std::exception& problem) {
        return tl::make_unexpected(fmt::format("these are not the books of an authority: {}", problem.what()));
    }
}

}  // namespace quorient::security
