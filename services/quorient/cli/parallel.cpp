#include "parallel.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

namespace quorient::cli {

void for_each(std::size_t count, unsigned threads, const OnProgress& on_progress, const std::function<void(std::size_t)>& task)
{
    std::atomic<std::size_t> next{0};
    std::size_t done = 0;
    std::mutex mutex;
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            task(i);
            const std::scoped_lock lock(mutex);
            ++done;
            if (on_progress) on_progress(done, count);
        }
    };
    const std::size_t wanted = threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> helpers;
    for (std::size_t k = 1; k < std::min(wanted, count); ++k) helpers.emplace_back(work);
    work();
}

}  // namespace quorient::cli
