#include "security.hpp"

#include <dlfcn.h>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <string>

namespace quorient::bus::cyclonedds {

namespace {

struct Plugin {
    const char* kind;     ///< in the properties' names
    const char* library;
    const char* function;  ///< init_… and finalize_…
};
constexpr std::initializer_list<Plugin> plugins{{"auth", "libdds_security_auth.so", "authentication"},
                                                {"crypto", "libdds_security_crypto.so", "crypto"},
                                                {"access", "libdds_security_ac.so", "access_control"}};

/// Debian keeps the plug-ins in a folder of their own beside the library, Cyclone DDS's own build beside it.
std::filesystem::path plugin_path(const char* library)
{
    Dl_info cyclone{};
    ::dladdr(reinterpret_cast<const void*>(&dds_create_participant), &cyclone);
    const auto beside = std::filesystem::path{cyclone.dli_fname ? cyclone.dli_fname : ""}.parent_path();
    const auto debian = beside / "libddsc0debian" / library;
    std::error_code unknown;
    return std::filesystem::exists(debian, unknown) ? debian : beside / library;
}

}  // namespace

Refusals& library_refusals()
{
    static Refusals& refusals = *[] {
        auto* made = new Refusals;  // outlives the library's threads
        dds_set_log_sink(
            [](void* target, const dds_log_data_t* entry) {
                std::string text{entry->message, entry->size};
                std::fprintf(stderr, "%s", text.c_str());
                while (!text.empty() && text.back() == '\n') text.pop_back();
                if ((entry->priority & (DDS_LC_ERROR | DDS_LC_WARNING)) != 0)
                    static_cast<Refusals*>(target)->add(RefusalReason::security, "Cyclone DDS: " + text);
            },
            made);
        return made;
    }();
    return refusals;
}

void secure(dds_qos_t& participant, const SecurityFiles& files)
{
    const auto set = [&](const std::string& name, const std::string& value) { dds_qset_prop(&participant, name.c_str(), value.c_str()); };
    for (const auto& [kind, library, function] : plugins) {
        const auto prefix = std::string{"dds.sec."} + kind + ".library.";
        set(prefix + "path", plugin_path(library));
        set(prefix + "init", std::string{"init_"} + function);
        set(prefix + "finalize", std::string{"finalize_"} + function);
    }
    set("dds.sec.auth.identity_ca", "file:" + files.identity_ca);
    set("dds.sec.auth.identity_certificate", "file:" + files.certificate);
    set("dds.sec.auth.private_key", "file:" + files.private_key);
    set("org.eclipse.cyclonedds.sec.auth.crl", "file:" + files.revoked);
    set("dds.sec.access.permissions_ca", "file:" + files.permissions_ca);
    set("dds.sec.access.governance", "file:" + files.governance);
    set("dds.sec.access.permissions", "file:" + files.permissions);
}

}  // namespace quorient::bus::cyclonedds
