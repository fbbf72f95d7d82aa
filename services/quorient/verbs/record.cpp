#include "quorient/bus/topics.hpp"
#include "quorient/recording/csv_writer.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "cli/output_file.hpp"
#include "cli/system_options.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <set>

namespace quorient::cli {

namespace {

struct RecordOptions {
    BusOptions bus;
    std::string file;
    double duration_s = 0;
    bool force = false;
};

/// Writes the frames of one unit, and remembers which other units there are.
class Recorder {
public:
    Recorder(const RecordOptions& options, OutputFile& file) : options_(options), file_(file) {}

    /// @returns false where the file takes no more.
    bool take(const SensorFrame& frame)
    {
        if (frame.unit != options_.bus.unit) {
            others_.insert(frame.unit);
            return true;
        }
        if (!writer_) writer_.emplace(file_.stream(), frame.axis_count, false);
        if (file_.failure().empty()) writer_->write(frame, nullptr);
        if (!file_.failure().empty()) return false;
        ++frames_;
        return true;
    }

    int conclude()
    {
        if (!file_.failure().empty()) {
            const auto lines = file_.keep_whole_lines();
            fail(fmt::format("{}: {}; the first {} frames are in it", file_.name(), file_.failure(), lines > 0 ? lines - 1 : 0));
        }
        file_.finish();
        if (frames_ == 0) {
            const auto seen = others_.empty() ? std::string{} : fmt::format("; there are frames of unit {}", fmt::join(others_, ", "));
            fmt::print(stderr, "no frame of unit {} came in domain {} on '{}'{}: {} is not written\n", options_.bus.unit,
                       options_.bus.domain, options_.bus.interface, seen, file_.name());
            return ExitCode::not_as_asked;
        }
        fmt::print(stderr, "{}: {} frames\n", file_.name(), frames_);
        return ExitCode::done;
    }

private:
    const RecordOptions& options_;
    OutputFile& file_;
    std::optional<recording::CsvWriter> writer_;
    std::uint64_t frames_ = 0;
    std::set<std::uint32_t> others_;
};

int record(const RecordOptions& options)
{
    OutputFile file{options.file, options.force};
    const auto bus = options.bus.open("quorient-record");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    Recorder recorder{options, file};
    loop.on(bus->subscribe(bus::topics::frame), [&](const SensorFrame& frame) {
        if (!loop.quit_requested() && !recorder.take(frame)) loop.quit(ExitCode::refused);
    });
    if (options.duration_s > 0)
        loop.timer([&] { loop.quit(0); }).set(clock.steady_ns() + static_cast<std::int64_t>(options.duration_s * 1e9));
    loop.run();
    return recorder.conclude();
}

}  // namespace

void add_record(Program& program)
{
    auto verb = program.verb("record", "Write a unit's frames to a CSV that replay reads back bit for bit");
    auto options = std::make_shared<RecordOptions>();
    options->bus.add_to(verb);
    verb.option("file", options->file, "Where to").required();
    verb.option("--duration", options->duration_s, "End after so many seconds; 0 = until Ctrl-C")
        .within(settings::not_negative)
        .value_name("S");
    add_force(verb, options->force);
    verb.footer("Example:\n  quorient record flight.csv --duration 60");
    verb.not_as_asked_if("no frame came");
    verb.run([options] {
        if (const int exit_code = record(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
