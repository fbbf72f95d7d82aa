#include "quorient/bus/interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <algorithm>
#include <memory>

namespace quorient::bus {

namespace {

struct Interface {
    std::string name;
    in_addr address;
    in_addr mask;
};

std::vector<Interface> interfaces()
{
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return {};
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owned{list, &freeifaddrs};
    std::vector<Interface> result;
    for (const auto* entry = list; entry; entry = entry->ifa_next) {
        if (!entry->ifa_addr || !entry->ifa_netmask || entry->ifa_addr->sa_family != AF_INET || !(entry->ifa_flags & IFF_UP)) continue;
        result.push_back({entry->ifa_name, reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr,
                          reinterpret_cast<const sockaddr_in*>(entry->ifa_netmask)->sin_addr});
    }
    return result;
}

std::string text_of(in_addr address)
{
    char text[INET_ADDRSTRLEN];
    return inet_ntop(AF_INET, &address, text, sizeof text);
}

}  // namespace

std::vector<std::string> addresses_of(std::string_view which)
{
    in_addr wanted{};
    const bool address = inet_pton(AF_INET, std::string{which}.c_str(), &wanted) == 1;
    std::vector<std::string> result;
    for (const auto& entry : interfaces()) {
        const in_addr_t subnet = entry.address.s_addr & entry.mask.s_addr;
        if (address ? wanted.s_addr == entry.address.s_addr || wanted.s_addr == subnet : entry.name == which)
            result.push_back(text_of(entry.address));
    }
    return result;
}

std::vector<std::string> own_addresses()
{
    auto found = interfaces();
    std::sort(found.begin(), found.end(),
              [](const Interface& a, const Interface& b) { return ntohl(a.address.s_addr) < ntohl(b.address.s_addr); });
    std::vector<std::string> result;
    for (const auto& entry : found) {
        if (ntohl(entry.address.s_addr) >> IN_CLASSA_NSHIFT != IN_LOOPBACKNET) result.push_back(text_of(entry.address));
    }
    return result;
}

std::vector<std::string> interface_names()
{
    std::vector<std::string> names;
    for (const auto& entry : interfaces()) {
        if (std::find(names.begin(), names.end(), entry.name) == names.end()) names.push_back(entry.name);
    }
    return names;
}

bool is_ipv4_address(const std::string& text)
{
    in_addr address{};
    return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

bool is_loopback(std::string_view interface)
{
    const auto addresses = addresses_of(interface);
    return !addresses.empty() && std::ranges::all_of(addresses, [](const std::string& address) { return address.starts_with("127."); });
}

}  // namespace quorient::bus
