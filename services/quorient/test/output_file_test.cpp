#include "cli/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

namespace quorient::cli {
namespace {

using testing::HasSubstr;

std::string content_of(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// What a step says on stderr when it ends the verb; "went on" where it does not.
std::string ending_of(const std::function<void()>& step)
{
    testing::internal::CaptureStderr();
    try {
        step();
    } catch (const Exit& exit) {
        EXPECT_EQ(exit.code, ExitCode::refused);
        return testing::internal::GetCapturedStderr();
    }
    testing::internal::GetCapturedStderr();
    return "went on";
}

class WrittenFile : public testing::Test {
protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / ("output-" + std::to_string(::getpid()));
};

TEST_F(WrittenFile, holds_what_was_written)
{
    OutputFile file(path("a"), false);
    file.stream() << "one\ntwo\n";
    file.finish();
    EXPECT_EQ(content_of(path("a")), "one\ntwo\n");
}

TEST_F(WrittenFile, holds_whole_rows_before_it_is_finished)
{
    OutputFile file(path("a"), false);
    file.stream() << "a row\n";
    EXPECT_EQ(content_of(path("a")), "a row\n") << "nothing is held back, so a killed process leaves whole rows";
}

TEST_F(WrittenFile, is_not_made_before_the_first_byte)
{
    OutputFile file(path("a"), false);
    file.finish();
    EXPECT_FALSE(std::filesystem::exists(path("a")));
}

TEST_F(WrittenFile, is_overwritten_only_by_force)
{
    std::ofstream(path("a")) << "old";
    EXPECT_THAT(ending_of([&] { OutputFile(path("a"), false); }), HasSubstr("exists already; --force overwrites it"));
    EXPECT_EQ(content_of(path("a")), "old");
    OutputFile file(path("a"), true);
    EXPECT_EQ(content_of(path("a")), "old") << "until there is something to write";
    file.stream() << "new";
    file.finish();
    EXPECT_EQ(content_of(path("a")), "new");
}

TEST_F(WrittenFile, is_refused_where_it_cannot_be)
{
    EXPECT_THAT(ending_of([&] { OutputFile(path("no/a"), false); }), HasSubstr("there is no folder"));
    EXPECT_THAT(ending_of([&] { OutputFile(folder_.string(), true); }), HasSubstr("is a directory"));
}

TEST_F(WrittenFile, tells_a_full_disk_at_the_write_and_at_the_end)
{
    OutputFile file("/dev/full", false);
    file.stream() << "a row\n";
    EXPECT_EQ(file.failure(), "No space left on device");
    EXPECT_THAT(ending_of([&] { file.finish(); }), HasSubstr("/dev/full: No space left on device"));
}

/// No file may grow beyond so many bytes meanwhile: a disk that is full.
class SmallDisk {
public:
    explicit SmallDisk(rlim_t bytes)
    {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit small{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~SmallDisk()
    {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int) = SIG_DFL;
};

TEST_F(WrittenFile, is_taken_away_where_a_document_is_cut)
{
    OutputFile file(path("page.html"), false);
    {
        const SmallDisk small(4096);
        file.stream() << std::string(10'000, 'x');
    }
    EXPECT_THAT(ending_of([&] { file.finish_document(); }), HasSubstr("File too large; it is not written"));
    EXPECT_FALSE(std::filesystem::exists(path("page.html")));
}

TEST_F(WrittenFile, keeps_whole_rows_and_counts_them_where_it_is_cut)
{
    OutputFile file(path("rows"), false);
    {
        const SmallDisk small(25);
        for (int row = 0; row < 5; ++row) file.stream() << "ten bytes\n";
    }
    EXPECT_THAT(ending_of([&] { file.finish_rows(); }), HasSubstr("File too large; 2 whole lines are in it"));
    EXPECT_EQ(content_of(path("rows")), "ten bytes\nten bytes\n");
}

TEST_F(WrittenFile, is_refused_where_it_is_read_or_written_under_another_name_too)
{
    std::ofstream(path("log")) << "rows\n";
    std::filesystem::create_symlink(path("log"), path("same"));
    EXPECT_THAT(ending_of([&] { refuse_shared_names({path("log"), ""}, {"", path("same")}); }), HasSubstr("is named twice"));
    EXPECT_THAT(ending_of([&] { refuse_shared_names({}, {path("a"), path("a")}); }), HasSubstr("is named twice"));
    EXPECT_EQ(ending_of([&] { refuse_shared_names({path("log")}, {path("a"), ""}); }), "went on");
}

TEST_F(WrittenFile, may_be_a_device_without_an_end)
{
    OutputFile file("/dev/null", false);
    file.stream() << "a row\n";
    EXPECT_EQ(ending_of([&] { file.finish(); }), "went on");
}

TEST_F(WrittenFile, is_cut_behind_its_last_whole_line)
{
    OutputFile file(path("a"), false);
    file.stream() << "one\ntwo\nthr";
    EXPECT_EQ(file.keep_whole_lines(), 2U);
    EXPECT_EQ(content_of(path("a")), "one\ntwo\n");
}

}  // namespace
}  // namespace quorient::cli
