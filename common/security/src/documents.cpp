#include "documents.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <tinyxml2.h>

namespace quorient::security {

namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;
using tinyxml2::XMLPrinter;

/// Fast DDS 2.9 reads a time in its host's time zone, Cyclone DDS in UTC. The certificates limit the period, so a grant is made longer at
/// both ends by more than any zone's offset.
constexpr std::int64_t widest_zone_s = 24 * 3600;

void begin(XMLPrinter& xml, const char* schema)
{
    xml.PushHeader(false, true);
    xml.OpenElement("dds");
    xml.PushAttribute("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
    xml.PushAttribute("xsi:noNamespaceSchemaLocation", schema);
}

void text(XMLPrinter& xml, const char* name, const std::string& value)
{
    xml.OpenElement(name);
    xml.PushText(value.c_str());
    xml.CloseElement();
}

void domain(XMLPrinter& xml, std::uint32_t id)
{
    xml.OpenElement("domains");
    text(xml, "id", std::to_string(id));
    xml.CloseElement();
}

void criteria(XMLPrinter& xml, const char* name, const std::vector<std::string>& topics)
{
    if (topics.empty()) return;
    xml.OpenElement(name);
    xml.OpenElement("topics");
    for (const auto& topic : topics) text(xml, "topic", topic);
    xml.CloseElement();
    xml.CloseElement();
}

std::string time_text(std::int64_t time_s)
{
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(time_s)));
}

const char* protection(bus::SecurityLevel level)
{
    return level == bus::SecurityLevel::encrypt ? "ENCRYPT" : "SIGN";
}

void topic_rule(XMLPrinter& xml, bus::SecurityLevel level)
{
    xml.OpenElement("topic_access_rules");
    xml.OpenElement("topic_rule");
    text(xml, "topic_expression", "*");
    for (const char* name :
         {"enable_discovery_protection", "enable_liveliness_protection", "enable_read_access_control", "enable_write_access_control"})
        text(xml, name, "true");
    text(xml, "metadata_protection_kind", protection(level));
    text(xml, "data_protection_kind", "NONE");  // the protected submessage contains the payload
    xml.CloseElement();
    xml.CloseElement();
}

const XMLElement* descend(const XMLElement* element, std::initializer_list<const char*> names)
{
    for (const char* name : names) {
        if (!element) return nullptr;
        element = element->FirstChildElement(name);
    }
    return element;
}

std::string text_at(const XMLElement* element, std::initializer_list<const char*> names)
{
    const auto* found = descend(element, names);
    return found && found->GetText() ? found->GetText() : "";
}

std::vector<std::string> topics_of(const XMLElement* rule, const char* criteria)
{
    std::vector<std::string> topics;
    const auto* list = descend(rule, {criteria, "topics"});
    for (const auto* topic = list ? list->FirstChildElement("topic") : nullptr; topic; topic = topic->NextSiblingElement("topic"))
        topics.emplace_back(topic->GetText() ? topic->GetText() : "");
    return topics;
}

/// @returns null if the text is not XML with this element under its root.
const XMLElement* root_of(XMLDocument& parsed, const std::string& document, const char* name)
{
    return parsed.Parse(document.data(), document.size()) == tinyxml2::XML_SUCCESS ? descend(parsed.FirstChildElement("dds"), {name}) : nullptr;
}

std::uint32_t domain_of(const XMLElement* rule)
{
    unsigned id = 0;
    const auto* element = descend(rule, {"domains", "id"});
    return element && element->QueryUnsignedText(&id) == tinyxml2::XML_SUCCESS ? id : 0;
}

}  // namespace

std::string governance_document(const Governance& governance)
{
    XMLPrinter xml;
    begin(xml, "http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd");
    xml.OpenElement("domain_access_rules");
    xml.OpenElement("domain_rule");
    domain(xml, governance.domain);
    text(xml, "allow_unauthenticated_participants", "false");
    text(xml, "enable_join_access_control", "true");
    text(xml, "discovery_protection_kind", protection(governance.level));
    text(xml, "liveliness_protection_kind", protection(governance.level));
    text(xml, "rtps_protection_kind", "NONE");
    topic_rule(xml, governance.level);
    for (int open = 0; open < 3; ++open) xml.CloseElement();
    return xml.CStr();
}

tl::expected<Governance, std::string> read_governance(const std::string& document)
{
    XMLDocument parsed;
    const auto* rule = descend(root_of(parsed, document, "domain_access_rules"), {"domain_rule"});
    const auto kind = text_at(rule, {"topic_access_rules", "topic_rule", "metadata_protection_kind"});
    const auto level = !kind.starts_with("SIGN") ? bus::SecurityLevel::encrypt : bus::SecurityLevel::sign;
    if (kind.empty()) return tl::make_unexpected("it is not a governance document of `quorient keys`");
    return Governance{domain_of(rule), level};
}

std::string permissions_document(const Permissions& permissions)
{
    XMLPrinter xml;
    begin(xml, "http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd");
    xml.OpenElement("permissions");
    for (const auto& common_name : permissions.common_names) {
        xml.OpenElement("grant");
        xml.PushAttribute("name", common_name.c_str());
        text(xml, "subject_name", "CN=" + common_name);
        xml.OpenElement("validity");
        text(xml, "not_before", time_text(permissions.validity.from_s - widest_zone_s));
        text(xml, "not_after", time_text(permissions.validity.until_s + widest_zone_s));
        xml.CloseElement();
        xml.OpenElement("allow_rule");
        domain(xml, permissions.domain);
        criteria(xml, "publish", permissions.access.publishes);
        criteria(xml, "subscribe", permissions.access.subscribes);
        xml.CloseElement();
        text(xml, "default", "DENY");
        xml.CloseElement();
    }
    for (int open = 0; open < 2; ++open) xml.CloseElement();
    return xml.CStr();
}

tl::expected<Permissions, std::string> read_permissions(const std::string& document, const std::string& common_name)
{
    XMLDocument parsed;
    const auto* root = root_of(parsed, document, "permissions");
    if (!root) return tl::make_unexpected("it is not a permissions document");
    for (const auto* grant = root->FirstChildElement("grant"); grant; grant = grant->NextSiblingElement("grant")) {
        if (text_at(grant, {"subject_name"}) != "CN=" + common_name) continue;
        const auto* rule = descend(grant, {"allow_rule"});
        return Permissions{domain_of(rule), {common_name}, {topics_of(rule, "publish"), topics_of(rule, "subscribe")}, {}};
    }
    return tl::make_unexpected(fmt::format("it permits nothing to CN={}", common_name));
}

std::string sign(const std::string& document, const Issuer& issuer)
{
    constexpr int flags = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
    const auto content = memory(document);
    const auto message = must(SignedDocument{PKCS7_sign(issuer.certificate.get(), issuer.key.get(), nullptr, content.get(), flags)}, "signature");
    const auto out = memory();
    must(SMIME_write_PKCS7(out.get(), message.get(), content.get(), flags) == 1, "signature");
    return content_of(*out);
}

tl::expected<std::string, std::string> verified(const std::string& signed_document, X509& authority)
{
    BIO* raw = nullptr;
    const SignedDocument message{SMIME_read_PKCS7(memory(signed_document).get(), &raw)};
    const Bio content{raw};
    const auto out = memory();
    const auto store = must(Store{X509_STORE_new()}, "store");
    must(X509_STORE_add_cert(store.get(), &authority) == 1, "store");
    const bool good = message && PKCS7_verify(message.get(), nullptr, store.get(), content.get(), out.get(), PKCS7_TEXT) == 1;
    ERR_clear_error();
    if (!message) return tl::make_unexpected("it is not a signed document (S/MIME)");
    if (!good) return tl::make_unexpected("its signature is not that of permissions_ca.pem, or it was changed after it was signed");
    return content_of(*out);
}

}  // namespace quorient::security
