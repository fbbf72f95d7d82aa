#include "parallel.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

namespace quorient::studies {

void for_each(std::size_t count, const RunSettings& settings, const OnProgress& on_progress, const std::function<void(std::size_t)>& task)
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
    const unsigned threads = settings.threads != 0 ? settings.threads : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> helpers;
    for (unsigned k = 1; k < threads; ++k) helpers.emplace_back(work);
    work();
}

}  // namespace quorient::studies
