#pragma once

#include "cli/program.hpp"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace quorient::cli {

/// What a program run by a test printed, and how it ended.
struct Output {
    int exit_code = 0;
    std::string out, error;
};

/// The words of a command line; double quotes keep blanks together.
inline std::vector<std::string> words_of(const std::string& line)
{
    std::vector<std::string> words;
    std::string word;
    bool quoted = false;
    bool begun = false;
    for (const char c : line + " ") {
        if (c == '"') {
            quoted = !quoted;
            begun = true;
        } else if (c == ' ' && !quoted) {
            if (begun) words.push_back(word);
            word.clear();
            begun = false;
        } else {
            word += c;
            begun = true;
        }
    }
    return words;
}

/// Runs `program arguments` as the user types them.
inline Output run_program(Program& program, const std::string& arguments)
{
    Output output;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    output.exit_code = program.run(words_of(arguments));
    output.out = testing::internal::GetCapturedStdout();
    output.error = testing::internal::GetCapturedStderr();
    return output;
}

}  // namespace quorient::cli
