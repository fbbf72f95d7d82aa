#include "quorient/bus/topics.hpp"
#include "quorient/recording/csv_writer.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "cli/system_options.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <optional>

namespace quorient::cli {

namespace {

struct RecordOptions {
    BusOptions bus;
    std::string file;
    double duration_s = 0;
};

int record(const RecordOptions& options)
{
    std::ofstream out{options.file};
    if (!out) {
        fmt::print(stderr, "{}: cannot be written\n", options.file);
        return 2;
    }
    const auto bus = options.bus.open("quorient-record");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    std::optional<recording::CsvWriter> writer;
    std::uint64_t frames = 0;
    loop.on(bus->subscribe(bus::topics::frame), [&](const SensorFrame& frame) {
        if (frame.unit != options.bus.unit) return;
        if (!writer) writer.emplace(out, frame.axis_count, false);
        writer->write(frame, nullptr);
        ++frames;
    });
    if (options.duration_s > 0)
        loop.timer([&] { loop.quit(0); }).set(clock.steady_ns() + static_cast<std::int64_t>(options.duration_s * 1e9));
    loop.run();
    fmt::print(stderr, "{}: {} frames\n", options.file, frames);
    return frames > 0 ? 0 : 1;
}

}  // namespace

void add_record(Program& program)
{
    auto verb = program.verb("record", "Write a unit's frames to a CSV that replay reads back bit for bit");
    auto options = std::make_shared<RecordOptions>();
    options->bus.add_to(verb);
    verb.option("file", options->file, "Where to").required();
    verb.option("--duration", options->duration_s, "End after so many seconds; 0 = until Ctrl-C").value_name("S");
    verb.footer("Example:\n  quorient record flight.csv --duration 60");
    verb.run([options] {
        if (const int exit_code = record(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
