#include "refused_endpoint.hpp"

#include <regex>
#include <string_view>

namespace quorient::bus::fastdds {

namespace {

constexpr std::string_view checking = "Error checking create";
constexpr std::string_view not_permitted = " topic not found in allow rule";

/// Fast DDS prints a participant's GUID as twelve hexadecimal numbers, without leading zeros.
std::optional<GuidPrefix> guid_from(const std::string& text)
{
    static const std::regex octet{"([0-9a-f]{1,2})(?:\\.|$)"};
    GuidPrefix guid{};
    std::size_t count = 0;
    for (std::sregex_iterator found{text.begin(), text.end(), octet}, end; found != end; ++found, ++count) {
        if (count < guid.size()) guid[count] = static_cast<std::uint8_t>(std::stoul((*found)[1], nullptr, 16));
    }
    return count == guid.size() ? std::optional{guid} : std::nullopt;
}

}  // namespace

std::optional<RefusedEndpoint> refused_endpoint(const std::string& entry)
{
    static const std::regex form{R"(^Error checking create remote (writer|reader) ([0-9a-f.]+)\|\S+ \((\S+) topic not found in allow rule)"};
    std::smatch part;
    if (!std::regex_search(entry, part, form)) return std::nullopt;
    const auto guid = guid_from(part[2]);
    if (!guid) return std::nullopt;
    return RefusedEndpoint{*guid, part[1] == "writer", part[3]};
}

bool announces_refused_endpoint(const std::string& entry)
{
    return entry.find(not_permitted) != std::string::npos && !entry.starts_with(checking);
}

}  // namespace quorient::bus::fastdds
