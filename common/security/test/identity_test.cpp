// Each file that can be wrong is, once: it is named, and what to do about it.

#include "quorient/security/identity.hpp"

#include "../src/certificates.hpp"
#include "../src/documents.hpp"
#include "../src/files.hpp"
#include "../src/layout.hpp"
#include "quorient/security/authority.hpp"
#include "temporary_directory.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <chrono>

namespace quorient::security {

namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t day_s = 24 * 3600;

std::int64_t now_s()
{
    return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

class IdentityTest : public testing::Test {
protected:
    IdentityTest()
    {
        make(layout.directory);
        make(directory.path() / "others");
    }

    static void make(const std::filesystem::path& path)
    {
        auto authority = Authority::open_or_make(path, now_s());
        ASSERT_TRUE(authority) << authority.error();
        ASSERT_TRUE(authority->govern(42, bus::SecurityLevel::encrypt, now_s()));
        for (const char* name : {"fdi-a", "fdi-b"})
            ASSERT_TRUE(authority->issue({name, Role::detector, access_of(Role::detector)}, now_s(), 100 * day_s));
    }

    std::vector<std::string> problems(std::int64_t at_s = now_s()) const
    {
        const auto identity = find_identity(layout.directory, joining, at_s);
        return identity ? std::vector<std::string>{} : identity.error();
    }

    void replace(const std::filesystem::path& file, const std::filesystem::path& by) const
    {
        std::filesystem::copy_file(by, file, std::filesystem::copy_options::overwrite_existing);
    }

    TemporaryDirectory directory;
    Layout layout{directory.path() / "keys"};
    Layout others{directory.path() / "others"};
    Joining joining{"fdi-a", Vendor::fastdds, 42, bus::SecurityLevel::encrypt};
};

TEST_F(IdentityTest, is_found_where_all_is_well)
{
    for (const auto vendor : {Vendor::fastdds, Vendor::cyclonedds}) {
        joining.vendor = vendor;
        const auto identity = find_identity(layout.directory, joining, now_s());
        ASSERT_TRUE(identity) << identity.error().front();
        EXPECT_EQ(identity->files.certificate, layout.certificate("fdi-a", vendor));
        EXPECT_NEAR(static_cast<double>(identity->expires_s), static_cast<double>(now_s() + 100 * day_s), 10.0);
        EXPECT_TRUE(bus::suits(vendor, identity->files.common_name));
    }
}

TEST_F(IdentityTest, names_every_missing_file_and_the_command_that_makes_it)
{
    for (const auto& file : {layout.identity_ca(), layout.permissions_ca(), layout.governance(), layout.revoked(), layout.key("fdi-a"),
                             layout.certificate("fdi-a", Vendor::fastdds), layout.permissions("fdi-a")}) {
        const auto content = *read_file(file);
        std::filesystem::remove(file);
        EXPECT_THAT(problems(), Contains(AllOf(HasSubstr(file.string()), HasSubstr("No such file"), HasSubstr("quorient keys"))));
        ASSERT_TRUE(write_file(file, content, 0600));
    }
    EXPECT_TRUE(problems().empty());
    joining.name = "fdi-z";
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("keys/fdi-z: there is no such directory"), HasSubstr("quorient keys SYSTEM.yaml"))));
}

TEST_F(IdentityTest, tells_a_certificate_out_of_its_time)
{
    EXPECT_TRUE(problems(now_s() + 99 * day_s).empty());
    EXPECT_THAT(problems(now_s() + 101 * day_s), ElementsAre(AllOf(HasSubstr("fastdds.pem: certificate has expired"), HasSubstr("--renew fdi-a"))));
    EXPECT_TRUE(problems(now_s() - day_s / 2).empty()) << "hosts' clocks differ";
    EXPECT_THAT(problems(now_s() - 2 * day_s), Contains(HasSubstr("not yet valid")));
}

TEST_F(IdentityTest, tells_a_revoked_certificate)
{
    ASSERT_TRUE(Authority::open(layout.directory)->revoke("fdi-a", now_s()));
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("fastdds.pem: certificate revoked"), HasSubstr("quorient keys SYSTEM.yaml"))));
    joining.name = "fdi-b";
    EXPECT_TRUE(problems().empty());
}

TEST_F(IdentityTest, tells_files_of_another_authority)
{
    replace(layout.certificate("fdi-a", Vendor::fastdds), others.certificate("fdi-a", Vendor::fastdds));
    EXPECT_THAT(problems(), Contains(AllOf(HasSubstr("fastdds.pem"), HasSubstr("another authority"))));
    EXPECT_THAT(problems(), Contains(AllOf(HasSubstr("key.pem"), HasSubstr("is not the key of"))));

    joining.name = "fdi-b";
    replace(layout.permissions("fdi-b"), others.permissions("fdi-b"));
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("fdi-b/permissions.p7s"), HasSubstr("signature"))));
    replace(layout.governance(), others.governance());
    EXPECT_THAT(problems(), Contains(AllOf(HasSubstr("governance.p7s"), HasSubstr("signature"))));
}

TEST_F(IdentityTest, tells_files_of_another_process)
{
    for (const auto& file : {layout.key("fdi-a"), layout.certificate("fdi-a", Vendor::fastdds), layout.permissions("fdi-a")})
        replace(file, layout.of("fdi-b") / file.filename());
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("fdi-a/fastdds.pem"), HasSubstr("CN=fdi-b."))));
}

TEST_F(IdentityTest, tells_the_certificate_of_the_other_vendor)
{
    replace(layout.certificate("fdi-a", Vendor::fastdds), layout.certificate("fdi-a", Vendor::cyclonedds));
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("fastdds.pem"), HasSubstr("is not fdi-a on fastdds"))));
}

TEST_F(IdentityTest, tells_permissions_that_a_member_wrote_itself)
{
    const Issuer member{certificate_from(*read_file(layout.certificate("fdi-a", Vendor::fastdds))), key_from(*read_file(layout.key("fdi-a")))};
    const auto name = common_name_of(*member.certificate);
    ASSERT_TRUE(write_file(layout.permissions("fdi-a"), sign(permissions_document({42, {name}, access_of(Role::sensor), {}}), member), 0644));
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("permissions.p7s"), HasSubstr("signature"))));
}

TEST_F(IdentityTest, tells_another_domain_and_another_level)
{
    joining.domain = 43;
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("governance.p7s"), HasSubstr("domain 42")),
                                        AllOf(HasSubstr("permissions.p7s"), HasSubstr("domain 42"))));
    joining.domain = 42;
    joining.level = bus::SecurityLevel::sign;
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("governance.p7s"), HasSubstr("level is encrypt"))));
}

TEST_F(IdentityTest, tells_a_key_that_others_may_read)
{
    ASSERT_EQ(::chmod(layout.key("fdi-a").c_str(), 0644), 0);
    EXPECT_THAT(problems(), ElementsAre(AllOf(HasSubstr("key.pem"), HasSubstr("0644"), HasSubstr("chmod 600"))));
    ASSERT_EQ(::chmod(layout.key("fdi-a").c_str(), 0440), 0);
    EXPECT_TRUE(problems().empty()) << "a secret that a group is given";
}

TEST_F(IdentityTest, tells_files_that_are_something_else)
{
    ASSERT_TRUE(write_file(layout.key("fdi-a"), "no key", 0600));
    ASSERT_TRUE(write_file(layout.revoked(), "no list", 0644));
    ASSERT_TRUE(write_file(layout.governance(), "no document", 0644));
    EXPECT_THAT(problems(), ElementsAre(HasSubstr("revoked.pem: is not"), HasSubstr("governance.p7s: it is not a signed document"),
                                        HasSubstr("key.pem: is not")));
}

TEST_F(IdentityTest, shows_no_key_in_what_it_tells)
{
    const auto key = *read_file(layout.key("fdi-a"));
    replace(layout.certificate("fdi-a", Vendor::fastdds), layout.key("fdi-a"));  // the wrong way round
    for (const auto& problem : problems()) EXPECT_EQ(problem.find(key.substr(40, 20)), std::string::npos) << problem;
}

}  // namespace

}  // namespace quorient::security
