#include "quorient/security/authority.hpp"

#include "../src/certificates.hpp"
#include "../src/documents.hpp"
#include "../src/files.hpp"
#include "../src/layout.hpp"
#include "temporary_directory.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <chrono>
#include <set>

namespace quorient::security {

namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

constexpr std::int64_t year_s = 365 * 24 * 3600;
constexpr std::uint32_t domain = 42;

std::int64_t now_s()
{
    return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

class AuthorityTest : public testing::Test {
protected:
    Authority found()
    {
        auto authority = Authority::open_or_make(layout.directory, now_s());
        EXPECT_TRUE(authority) << authority.error();
        EXPECT_TRUE(authority->govern(domain, bus::SecurityLevel::encrypt, now_s()));
        return std::move(*authority);
    }

    std::string text(const std::filesystem::path& file) const
    {
        auto content = read_file(file);
        EXPECT_TRUE(content) << file;
        return content.value_or("");
    }

    std::string document(const std::filesystem::path& file) const
    {
        auto content = verified(text(file), *certificate_from(text(layout.permissions_ca())));
        EXPECT_TRUE(content) << content.error();
        return content.value_or("");
    }

    std::string why_refused(const std::string& name, Vendor vendor) const
    {
        return refusal(*certificate_from(text(layout.certificate(name, vendor))), *certificate_from(text(layout.identity_ca())),
                       *revocation_list_from(text(layout.revoked())), now_s());
    }

    TemporaryDirectory directory;
    Layout layout{directory.path() / "keys"};
    Member fdi_a{"fdi-a", Role::detector, access_of(Role::detector)};
};

TEST_F(AuthorityTest, issues_certificates_that_count_on_either_vendor)
{
    auto authority = found();
    ASSERT_TRUE(authority.issue(fdi_a, now_s(), year_s));
    for (const auto vendor : {Vendor::fastdds, Vendor::cyclonedds}) {
        EXPECT_EQ(why_refused("fdi-a", vendor), "");
        EXPECT_TRUE(bus::suits(vendor, common_name_of(*certificate_from(text(layout.certificate("fdi-a", vendor))))));
    }
}

TEST_F(AuthorityTest, lets_nobody_else_read_a_private_key)
{
    ASSERT_TRUE(found().issue(fdi_a, now_s(), year_s));
    for (const auto& file : {layout.key("fdi-a"), layout.identity_ca_key(), layout.permissions_ca_key()}) {
        struct stat status {};
        ASSERT_EQ(::stat(file.c_str(), &status), 0) << file;
        EXPECT_EQ(status.st_mode & 07777U, 0600U) << file;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(layout.directory)) {
        if (!entry.is_regular_file() || entry.path().extension() == ".key" || entry.path().filename() == "key.pem") continue;
        EXPECT_THAT(text(entry.path()), Not(HasSubstr("PRIVATE KEY"))) << entry.path();
    }
}

TEST_F(AuthorityTest, permits_a_role_its_topics_and_no_other)
{
    ASSERT_TRUE(found().issue(fdi_a, now_s(), year_s));
    const auto name = common_name_of(*certificate_from(text(layout.certificate("fdi-a", Vendor::fastdds))));
    const auto permissions = read_permissions(document(layout.permissions("fdi-a")), name);
    ASSERT_TRUE(permissions) << permissions.error();
    EXPECT_EQ(permissions->domain, domain);
    EXPECT_EQ(permissions->access, fdi_a.access);
    EXPECT_THAT(permissions->access.publishes, Each(AllOf(Not(HasSubstr("*")), Not(HasSubstr("attitude")))));
    EXPECT_THAT(document(layout.permissions("fdi-a")), HasSubstr("<default>DENY</default>"));
    EXPECT_FALSE(read_permissions(document(layout.permissions("fdi-a")), "fdi-b.fastdds.0"));
}

TEST_F(AuthorityTest, does_not_take_a_members_signature_for_its_own)
{
    ASSERT_TRUE(found().issue(fdi_a, now_s(), year_s));
    const Issuer member{certificate_from(text(layout.certificate("fdi-a", Vendor::fastdds))), key_from(text(layout.key("fdi-a")))};
    const auto forged = sign(document(layout.permissions("fdi-a")), member);
    EXPECT_FALSE(verified(forged, *certificate_from(text(layout.permissions_ca()))));
    // With one authority for both it would be taken: the reason why there are two.
    EXPECT_TRUE(verified(forged, *certificate_from(text(layout.identity_ca()))));
}

TEST_F(AuthorityTest, refuses_a_document_that_was_changed)
{
    found();
    auto governance = text(layout.governance());
    governance.replace(governance.find("ENCRYPT"), 7, "NONE   ");
    const auto changed = verified(governance, *certificate_from(text(layout.permissions_ca())));
    ASSERT_FALSE(changed);
    EXPECT_THAT(changed.error(), HasSubstr("signature"));
}

TEST_F(AuthorityTest, remembers_what_it_issued)
{
    ASSERT_TRUE(found().issue(fdi_a, now_s(), year_s));
    const auto again = Authority::open(layout.directory);
    ASSERT_TRUE(again) << again.error();
    EXPECT_EQ(again->domain(), domain);
    EXPECT_EQ(again->level(), bus::SecurityLevel::encrypt);
    ASSERT_NE(again->find("fdi-a"), nullptr);
    EXPECT_EQ(again->find("fdi-a")->member.access, fdi_a.access);
    EXPECT_EQ(again->find("fdi-b"), nullptr);
}

TEST_F(AuthorityTest, renews_with_another_key_under_the_same_name)
{
    auto authority = found();
    ASSERT_TRUE(authority.issue(fdi_a, now_s(), year_s));
    const auto key = text(layout.key("fdi-a"));
    const auto common_name = authority.find("fdi-a")->certificates.front().common_name;
    ASSERT_TRUE(authority.issue(fdi_a, now_s(), year_s));
    EXPECT_NE(text(layout.key("fdi-a")), key);
    EXPECT_EQ(authority.find("fdi-a")->certificates.front().common_name, common_name);
}

TEST_F(AuthorityTest, revokes_every_certificate_that_a_name_ever_had_and_no_other)
{
    auto authority = found();
    ASSERT_TRUE(authority.issue(fdi_a, now_s(), year_s));
    ASSERT_TRUE(authority.issue({"fdi-b", Role::detector, fdi_a.access}, now_s(), year_s));
    const auto old = certificate_from(text(layout.certificate("fdi-a", Vendor::fastdds)));
    ASSERT_TRUE(authority.issue(fdi_a, now_s(), year_s));
    ASSERT_TRUE(authority.revoke("fdi-a", now_s()));

    EXPECT_THAT(why_refused("fdi-a", Vendor::fastdds), HasSubstr("revoked"));
    EXPECT_THAT(why_refused("fdi-a", Vendor::cyclonedds), HasSubstr("revoked"));
    EXPECT_THAT(refusal(*old, *certificate_from(text(layout.identity_ca())), *revocation_list_from(text(layout.revoked())), now_s()),
                HasSubstr("revoked"));
    EXPECT_EQ(why_refused("fdi-b", Vendor::fastdds), "");
    EXPECT_FALSE(authority.revoke("fdi-c", now_s()));

    ASSERT_TRUE(authority.issue(fdi_a, now_s(), year_s));
    EXPECT_EQ(why_refused("fdi-a", Vendor::fastdds), "") << "new keys of a name that was revoked";
    EXPECT_FALSE(authority.find("fdi-a")->revoked);
}

TEST_F(AuthorityTest, permits_in_another_domain_when_the_system_moves)
{
    auto authority = found();
    ASSERT_TRUE(authority.issue(fdi_a, now_s(), year_s));
    const auto key = text(layout.key("fdi-a"));
    ASSERT_TRUE(authority.govern(43, bus::SecurityLevel::sign, now_s()));
    const auto name = common_name_of(*certificate_from(text(layout.certificate("fdi-a", Vendor::cyclonedds))));
    EXPECT_EQ(read_permissions(document(layout.permissions("fdi-a")), name)->domain, 43U);
    const auto governance = read_governance(document(layout.governance()));
    EXPECT_EQ(governance->domain, 43U);
    EXPECT_EQ(governance->level, bus::SecurityLevel::sign);
    EXPECT_EQ(text(layout.key("fdi-a")), key);
}

TEST_F(AuthorityTest, takes_no_name_that_leaves_its_folder)
{
    auto authority = found();
    for (const char* name : {"", "../fdi-a", "a/b", ".", "authority", "shared", "a b", "CN=x"})
        EXPECT_FALSE(authority.issue({name, Role::monitor, {}}, now_s(), year_s)) << name;
}

TEST(Access, of_every_role_is_what_nobody_else_needs)
{
    for (const auto role : {Role::sensor, Role::detector, Role::integrator, Role::voter, Role::monitor, Role::commander, Role::consumer}) {
        const auto publishes = access_of(role).publishes;
        const std::set<std::string> topics(publishes.begin(), publishes.end());
        EXPECT_EQ(topics.contains("quorient/command"), role == Role::commander) << to_string(role);
        EXPECT_EQ(topics.contains("quorient/frame"), role == Role::sensor) << to_string(role);
        EXPECT_EQ(topics.contains("quorient/voted"), role == Role::voter) << to_string(role);
        EXPECT_EQ(role_from(to_string(role)), role);
    }
    EXPECT_TRUE(access_of(Role::monitor).publishes.empty());
    EXPECT_FALSE(role_from("admin"));
}

}  // namespace

}  // namespace quorient::security
