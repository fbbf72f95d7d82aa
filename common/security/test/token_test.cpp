#include "quorient/security/token.hpp"

#include "temporary_directory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <fstream>

namespace quorient::security {

namespace {

using testing::HasSubstr;
using testing::Not;

const std::string secret = "0123456789abcdef0123456789ABCDEF";

class TokenFile : public testing::Test {
protected:
    tl::expected<Token, std::string> read(const std::string& content, mode_t mode = 0600)
    {
        std::ofstream{path_} << content;
        EXPECT_EQ(::chmod(path_.c_str(), mode), 0);
        return Token::read(path_);
    }

    TemporaryDirectory directory_;
    std::filesystem::path path_ = directory_.path() / "token";
};

}  // namespace

TEST_F(TokenFile, admits_its_own_text_alone)
{
    const auto token = read(secret + "\n");
    ASSERT_TRUE(token) << token.error();
    EXPECT_TRUE(token->admits("Bearer " + secret));
    auto last_differs = secret;
    last_differs.back() = 'E';
    for (const std::string& wrong : {std::string{}, secret, std::string{"Bearer "}, "bearer" + secret, "Basic " + secret,
                                     "Bearer " + secret.substr(1), "Bearer " + secret + "0", "Bearer " + secret + "\n",
                                     "Bearer " + last_differs})
        EXPECT_FALSE(token->admits(wrong)) << wrong;
}

TEST_F(TokenFile, that_others_can_read_is_refused_and_one_for_the_group_is_not)
{
    for (const mode_t mode : {0604U, 0602U, 0620U, 0644U, 0666U}) {
        const auto token = read(secret, mode);
        ASSERT_FALSE(token) << mode;
        EXPECT_THAT(token.error(), HasSubstr("chmod 600"));
    }
    EXPECT_TRUE(read(secret, 0640));
    EXPECT_TRUE(read(secret, 0400));
}

TEST_F(TokenFile, that_is_short_or_no_token_is_refused_without_repeating_it)
{
    for (const std::string& bad : {std::string{}, std::string{"\n"}, secret.substr(1), secret + "\n\n", secret + " " + secret,
                                   secret + "\r\n", secret + "\xc3\xa4"}) {
        const auto token = read(bad);
        ASSERT_FALSE(token) << bad;
        EXPECT_THAT(token.error(), HasSubstr(path_.string() + ": expected one line of at least 32 letters"));
        EXPECT_THAT(token.error(), Not(HasSubstr(secret.substr(1))));
    }
}

TEST_F(TokenFile, that_never_ends_is_refused_with_the_limit)
{
    const auto token = Token::read("/dev/zero");
    ASSERT_FALSE(token);
    EXPECT_THAT(token.error(), HasSubstr("/dev/zero: cannot be read: more than 16 MB"));
}

TEST_F(TokenFile, that_is_not_there_is_an_error_that_says_how_to_make_one)
{
    const auto token = Token::read(path_);
    ASSERT_FALSE(token);
    EXPECT_THAT(token.error(), HasSubstr("cannot be read: No such file or directory: (umask 077; openssl rand -hex 32 > "));
}

}  // namespace quorient::security
