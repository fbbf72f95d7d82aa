#include "security.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <string>

namespace quorient::bus::fastdds {

namespace {

/// Reads the library's log: no interface reports these refusals.
class SecurityLog final : public dds::LogConsumer {
public:
    explicit SecurityLog(Refusals& refusals) : refusals_(refusals) {}

    void Consume(const dds::Log::Entry& entry) override
    {
        const std::string_view category = entry.context.category ? entry.context.category : "";
        if (entry.kind == dds::Log::Kind::Error && category.starts_with("SECURITY")) refusals_.add("Fast DDS: " + entry.message);
    }

private:
    Refusals& refusals_;
};

}  // namespace

Refusals& library_refusals()
{
    static Refusals& refusals = *[] {
        auto* made = new Refusals;  // outlives the log's thread, which ends with the process
        dds::Log::RegisterConsumer(std::make_unique<SecurityLog>(*made));
        return made;
    }();
    return refusals;
}

void secure(wire::PropertyPolicy& participant, const SecurityFiles& files)
{
    const auto set = [&](const std::string& name, const std::string& value) { participant.properties().emplace_back(name, value); };
    set("dds.sec.auth.plugin", "builtin.PKI-DH");
    set("dds.sec.access.plugin", "builtin.Access-Permissions");
    set("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
    const std::string authentication = "dds.sec.auth.builtin.PKI-DH.";
    set(authentication + "identity_ca", "file://" + files.identity_ca);
    set(authentication + "identity_certificate", "file://" + files.certificate);
    set(authentication + "private_key", "file://" + files.private_key);
    set(authentication + "identity_crl", "file://" + files.revoked);
    const std::string access = "dds.sec.access.builtin.Access-Permissions.";
    set(access + "permissions_ca", "file://" + files.permissions_ca);
    set(access + "governance", "file://" + files.governance);
    set(access + "permissions", "file://" + files.permissions);
}

}  // namespace quorient::bus::fastdds
