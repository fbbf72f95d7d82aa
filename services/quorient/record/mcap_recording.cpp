#include "mcap_recording.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>

namespace quorient::record {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t queue_bytes = std::size_t{32} << 20U;  // half a minute of a unit at 200 Hz; two such buffers are held
constexpr auto write_patience = std::chrono::milliseconds{100};

std::string numbered(const fs::path& file, std::size_t number)
{
    return (file.parent_path() / fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string())).string();
}

/// A rotation must not begin among files of an older one, which would then seem to belong to it.
void refuse_older_files(const fs::path& file)
{
    const auto folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const auto begin = file.stem().string() + "_";
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator(folder, unreadable)) {
        const auto name = entry.path().stem().string();
        const bool digits = name.size() == begin.size() + 4 && std::all_of(name.end() - 4, name.end(), [](char c) { return c >= '0' && c <= '9'; });
        if (digits && name.starts_with(begin) && entry.path().extension() == file.extension())
            cli::fail(fmt::format("{}: exists already; --force overwrites it", entry.path().string()));
    }
}

}  // namespace

McapRecording::McapRecording(std::string file, bool force, Rotation rotation)
    : name_(std::move(file)), force_(force), rotation_(rotation), queue_(queue_bytes)
{
    if (rotation_.is_asked() && !force_) refuse_older_files(name_);
    const cli::OutputFile looked_at(next_name(), force_);
    thread_ = std::thread([this] { run(); });
}

McapRecording::~McapRecording()
{
    if (thread_.joinable()) finish();
}

McapRecording::Result McapRecording::finish()
{
    queue_.close();
    thread_.join();
    result_.dropped = queue_.dropped();
    return result_;
}

void McapRecording::run()
{
    std::vector<std::uint8_t> batch;
    while (queue_.take(batch, write_patience)) {
        SampleQueue::each(batch, [&](const SampleQueue::Header& header, std::span<const std::uint8_t> cdr) { write(header, cdr); });
        if (file_) file_->flush_when_due();
    }
    close();
}

void McapRecording::write(const SampleQueue::Header& header, std::span<const std::uint8_t> cdr)
{
    if (failed_) return;
    if (header.channel == channel_of(bus::TypeId::cluster_description)) description_.assign(cdr.begin(), cdr.end());
    if (file_ && is_rotation_due()) close();
    if (!file_) open_next(header.log_time_ns);
    if (!file_) return;
    file_->add(header.channel, header.log_time_ns, cdr);
    if (!file_->failure().empty()) close();
}

void McapRecording::open_next(std::uint64_t log_time_ns)
{
    try {
        const auto name = next_name();
        file_ = std::make_unique<McapFile>(name, force_);
        result_.files.push_back(name);
        if (result_.files.size() > 1 && !description_.empty())
            file_->add(channel_of(bus::TypeId::cluster_description), log_time_ns, description_);
    } catch (const cli::Exit&) {
        failed_ = true;
    } catch (const std::exception&) {
        failed_ = true;
    }
}

/// Ends the file in hand, and the recording where that fails.
void McapRecording::close()
{
    if (!file_) return;
    if (!file_->finish()) failed_ = true;
    result_.samples += file_->samples();
    result_.frames += file_->frames();
    file_.reset();
}

bool McapRecording::is_rotation_due() const
{
    constexpr double megabyte = 1e6;
    if (rotation_.after_mb && static_cast<double>(file_->size()) >= *rotation_.after_mb * megabyte) return true;
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - file_->opened();
    return rotation_.after_s && age.count() >= *rotation_.after_s;
}

std::string McapRecording::next_name() const
{
    return rotation_.is_asked() ? numbered(name_, result_.files.size()) : name_;
}

}  // namespace quorient::record
