#pragma once

#include "quorient/recording/reader.hpp"

#include "data_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace quorient::recording {

inline std::filesystem::path data_dir()
{
    return data_folder(QUORIENT_SOURCE_DIR);
}

/// A folder of its own for each test, gone with it.
class LogFiles : public testing::Test {
protected:
    LogFiles()
    {
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        dir_ = std::filesystem::temp_directory_path() / (std::string("quorient_") + test->name() + "_" + std::to_string(getpid()));
        std::filesystem::create_directories(dir_);
    }
    ~LogFiles() override { std::filesystem::remove_all(dir_); }

    std::filesystem::path write(const std::string& name, const std::string& content) const
    {
        std::ofstream(dir_ / name, std::ios::binary) << content;
        return dir_ / name;
    }

    std::filesystem::path write(const std::string& name, const std::vector<std::uint8_t>& content) const
    {
        return write(name, std::string(content.begin(), content.end()));
    }

private:
    std::filesystem::path dir_;
};

struct Log {
    std::vector<RecordedFrame> frames;
    std::vector<std::string> problems;
    Statistics statistics;
};

inline Log read_all(Reader& reader)
{
    Log log;
    RecordedFrame frame;
    for (auto outcome = reader.next(frame); outcome != ReadOutcome::end; outcome = reader.next(frame)) {
        if (outcome == ReadOutcome::frame) log.frames.push_back(frame);
        else log.problems.push_back(reader.problem());
    }
    log.statistics = reader.statistics();
    return log;
}

inline Log read_all(const std::filesystem::path& file)
{
    const auto reader = open_log(file);
    if (!reader) {
        ADD_FAILURE() << reader.error();
        return {};
    }
    return read_all(**reader);
}

/// Times that only move forward, and intervals that make sense: what every log, however broken, must keep.
inline void expect_orderly(const Log& log)
{
    std::int64_t last_ns = 0;
    for (const RecordedFrame& frame : log.frames) {
        ASSERT_GT(frame.time_ns, last_ns);
        ASSERT_GT(frame.interval_s, 0.0);
        last_ns = frame.time_ns;
    }
    const Statistics& s = log.statistics;
    EXPECT_EQ(s.frames, log.frames.size());
    EXPECT_EQ(log.problems.size(), s.checksum_failures + s.malformed + s.nan + s.repeated + s.irregular + (s.truncated_bytes > 0 ? 1 : 0));
}

}  // namespace quorient::recording
