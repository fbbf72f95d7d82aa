#include "quorient/bus/topics.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/recording/csv_writer.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "cli/output_file.hpp"
#include "cli/system_options.hpp"
#include "record/mcap_recording.hpp"
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
    record::Rotation rotation;
    bool force = false;
};

/// The frames of the unit that is recorded, and which other units there are.
class FrameCount {
public:
    explicit FrameCount(const BusOptions& bus) : bus_(bus) {}

    /// @returns whether it is a frame of the unit.
    bool add(const SensorFrame& frame)
    {
        if (frame.unit != bus_.unit) {
            others_.insert(frame.unit);
            return false;
        }
        if (latest_ && latest_->epoch == frame.epoch && frame.sequence > latest_->sequence) missing_ += frame.sequence - latest_->sequence - 1;
        latest_ = identity_of(frame);
        ++frames_;
        return true;
    }

    std::uint64_t frames() const { return frames_; }

    /// How many never arrived, for the last line; empty where none is missing.
    std::string missing() const { return missing_ == 0 ? std::string{} : fmt::format(", {} more never arrived", missing_); }

    std::string why_none() const
    {
        const auto seen = others_.empty() ? std::string{} : fmt::format("; there are frames of unit {}", fmt::join(others_, ", "));
        return fmt::format("no frame of unit {} came in domain {} on '{}'{}", bus_.unit, bus_.joined_domain(), bus_.interface, seen);
    }

private:
    const BusOptions& bus_;
    std::optional<Identity> latest_;
    std::uint64_t frames_ = 0;
    std::uint64_t missing_ = 0;
    std::set<std::uint32_t> others_;
};

/// A bus and a loop, until the duration is over or somebody ends it.
class Session {
public:
    explicit Session(const RecordOptions& options)
        : bus_(options.bus.open("quorient-record")), loop_(*bus_, clock_, runtime::termination_requested())
    {
        if (options.duration_s > 0)
            loop_.timer([this] { loop_.quit(0); }).set(clock_.steady_ns() + nanoseconds(options.duration_s));
    }

    bus::Bus& bus() { return *bus_; }
    runtime::EventLoop& loop() { return loop_; }

private:
    std::unique_ptr<bus::Bus> bus_;
    runtime::SystemClock clock_;
    runtime::EventLoop loop_;
};

int record_csv(const RecordOptions& options)
{
    OutputFile file{options.file, options.force};
    Session session{options};
    FrameCount count{options.bus};
    std::optional<recording::CsvWriter> writer;
    session.loop().on(session.bus().subscribe(bus::topics::frame), [&](const SensorFrame& frame) {
        if (session.loop().quit_requested() || !count.add(frame)) return;
        if (!writer) writer.emplace(file.stream(), frame.axis_count, false);
        if (file.failure().empty()) writer->write(frame, nullptr);
        if (!file.failure().empty()) session.loop().quit(ExitCode::refused);
    });
    session.loop().run();
    if (!file.failure().empty()) {
        const auto lines = file.keep_whole_lines();
        fail(fmt::format("{}: {}; the first {} frames are in it", file.name(), file.failure(), lines > 0 ? lines - 1 : 0));
    }
    file.finish();
    if (count.frames() == 0) {
        fmt::print(stderr, "{}: {} is not written\n", count.why_none(), file.name());
        return ExitCode::not_as_asked;
    }
    fmt::print(stderr, "{}: {} frames{}\n", file.name(), count.frames(), count.missing());
    return ExitCode::done;
}

int conclude(const record::McapRecording::Result& result, const FrameCount& count, const std::string& file)
{
    const auto files = result.files.size() == 1 ? result.files.front() : fmt::format("{} files from {}", result.files.size(), file);
    if (result.samples > 0)
        fmt::print(stderr, "{}: {} frames{}, {} samples in all\n", files, result.frames, count.missing(), result.samples);
    if (result.dropped > 0) fmt::print(stderr, "{} samples were dropped, since the file was written too slowly\n", result.dropped);
    if (count.frames() == 0) fmt::print(stderr, "{}{}\n", count.why_none(), result.files.empty() ? fmt::format(": {} is not written", file) : "");
    return result.dropped > 0 || count.frames() == 0 ? ExitCode::not_as_asked : ExitCode::done;
}

int record_mcap(const RecordOptions& options)
{
    record::McapRecording recording{options.file, options.force, options.rotation};
    Session session{options};
    FrameCount count{options.bus};
    auto& loop = session.loop();
    const auto record = [&](const auto& topic) {
        using Message = typename std::decay_t<decltype(topic)>::Message;
        loop.on(session.bus().subscribe(topic), [&](const Message& message) {
            if (loop.quit_requested()) return;
            if constexpr (std::is_same_v<Message, SensorFrame>) count.add(message);
            if (message.unit == options.bus.unit) recording.take(topic, message, loop.clock().wall_ns());
        });
    };
    std::apply([&](const auto&... topic) { (record(topic), ...); }, bus::topics::all);
    constexpr std::int64_t check_ns = 50'000'000;
    loop.every(check_ns, [&] {
        if (recording.failed()) loop.quit(ExitCode::refused);
    });
    loop.run();
    const auto result = recording.finish();
    return recording.failed() ? ExitCode::refused : conclude(result, count, options.file);
}

int record(const RecordOptions& options)
{
    if (!options.file.ends_with(".csv")) return record_mcap(options);
    if (options.rotation.is_asked()) fail("--rotate-mb and --rotate-s are for MCAP files: name one that does not end in .csv");
    return record_csv(options);
}

}  // namespace

void add_record(Program& program)
{
    auto verb = program.verb("record", "Write all topics of a unit to an MCAP file, or its frames to a CSV; replay reads either back bit for bit");
    auto options = std::make_shared<RecordOptions>();
    options->bus.add_to(verb);
    verb.option("file", options->file, "Where to: FILE.csv has the frames alone, any other name all topics in MCAP").required();
    verb.option("--duration", options->duration_s, "End after so many seconds; 0 = until Ctrl-C")
        .within(settings::not_negative)
        .value_name("S");
    verb.option("--rotate-mb", options->rotation.after_mb, "Go on in a new file after so many megabytes: FILE_0000.mcap, FILE_0001.mcap, ...")
        .within(settings::above_zero)
        .value_name("MB");
    verb.option("--rotate-s", options->rotation.after_s, "Likewise after so many seconds").within(settings::above_zero).value_name("S");
    verb.option("--lease", options->bus.voted_lease_s, "Of `voted`, if above max(50 ms, 3 intervals) in the system file")
        .within(settings::above_zero)
        .value_name("S")
        .shows_default();
    add_force(verb, options->force);
    verb.footer("Example:\n  quorient record flight.mcap --duration 60");
    verb.not_as_asked_if("no frame came, or samples were dropped");
    verb.run([options] {
        if (const int exit_code = record(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
