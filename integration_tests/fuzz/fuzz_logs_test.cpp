// The readers of logs, as fuzz_test runs the services: their corpora are logs that the tests' own writers make.

#include "log_seeds.hpp"
#include "run.hpp"
#include "targets.hpp"

#include <gtest/gtest.h>

namespace quorient::fuzz {

namespace {

void run_log(const char* name, void (*target)(const std::uint8_t*, std::size_t))
{
    run(name, target, 3000, 4096, log_seeds(name));
}

TEST(FuzzLogs, dataflash_logs_of_any_kind_are_read_to_their_end)
{
    run_log("dataflash", dataflash);
}

TEST(FuzzLogs, ulogs_of_any_kind_are_read_to_their_end)
{
    run_log("ulog", ulog);
}

TEST(FuzzLogs, tables_of_any_kind_are_read_to_their_end_or_refused)
{
    run_log("csv", csv);
}

TEST(FuzzLogs, files_of_any_kind_are_read_to_their_end_or_refused)
{
    run_log("logs", logs);
}

TEST(FuzzLogs, bags_of_ros_of_any_kind_are_read_to_their_end_or_refused)
{
    run_log("mcap", mcap);
    run_log("sqlite", sqlite);
}

TEST(FuzzLogs, samples_with_times_of_any_kind_give_frames_in_order_that_no_sample_exceeds)
{
    run_log("times", times);
}

}  // namespace

}  // namespace quorient::fuzz
