#include "frame_store.hpp"

#include <cstring>

namespace quorient::cli {
namespace {

constexpr std::size_t most_bytes_in_memory = std::size_t{32} << 20U;

}  // namespace

bool FrameStore::add(const recording::AlignedFrame& frame)
{
    record_.resize(record_size());
    const Kept kept{frame.time_ns, static_cast<float>(frame.interval_s), frame.valid_mask, frame.clipped_mask, frame.after_gap ? 1U : 0U};
    std::memcpy(record_.data(), &kept, sizeof kept);
    for (std::size_t m = 0; m < instruments_; ++m)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto rate = static_cast<float>(frame.rate_rad_s[m][k]);
            std::memcpy(record_.data() + sizeof kept + (3 * m + k) * sizeof rate, &rate, sizeof rate);
        }
    if (!file_ && memory_.size() + record_.size() <= most_bytes_in_memory) {
        if (memory_.empty()) memory_.reserve(most_bytes_in_memory);  // growing would hold it twice
        memory_.insert(memory_.end(), record_.begin(), record_.end());
        return true;
    }
    if (!file_) file_ = temporary_file();
    if (!file_ || std::fwrite(record_.data(), record_.size(), 1, file_.get()) != 1) return false;
    ++in_file_;
    return true;
}

bool FrameStore::flush()
{
    return !file_ || std::fflush(file_.get()) == 0;
}

bool FrameStore::each(const std::function<void(const recording::AlignedFrame&)>& visit)
{
    recording::AlignedFrame frame;
    for (std::size_t at = 0; at < memory_.size(); at += record_size()) {
        unpack(memory_.data() + at, frame);
        visit(frame);
    }
    if (in_file_ == 0) return true;
    if (!flush() || std::fseek(file_.get(), 0, SEEK_SET) != 0) return false;
    for (std::uint64_t i = 0; i < in_file_; ++i) {
        if (std::fread(record_.data(), record_.size(), 1, file_.get()) != 1) return false;
        unpack(record_.data(), frame);
        visit(frame);
    }
    return true;
}

void FrameStore::unpack(const unsigned char* record, recording::AlignedFrame& frame) const
{
    Kept kept;
    std::memcpy(&kept, record, sizeof kept);
    frame.time_ns = kept.time_ns;
    frame.interval_s = static_cast<double>(kept.interval_s);
    frame.count = instruments_;
    frame.valid_mask = kept.valid_mask;
    frame.clipped_mask = kept.clipped_mask;
    frame.after_gap = kept.after_gap != 0;
    for (std::size_t m = 0; m < instruments_; ++m)
        for (std::size_t k = 0; k < 3; ++k) {
            float rate = 0;
            std::memcpy(&rate, record + sizeof kept + (3 * m + k) * sizeof rate, sizeof rate);
            frame.rate_rad_s[m][k] = static_cast<double>(rate);
        }
}

}  // namespace quorient::cli
