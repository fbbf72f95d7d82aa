#include "../src/sample_queue.hpp"

#include <gtest/gtest.h>
#include <deque>
#include <random>

namespace quorient::bus {

TEST(SampleQueue, gives_back_what_went_in_as_a_plain_queue_of_bounded_length_does)
{
    constexpr std::size_t most = 21;
    constexpr unsigned seed = 5;
    SampleQueue queue(sizeof(int), most);
    std::deque<int> plain;
    std::mt19937 random{seed};
    for (int step = 0; step < 10'000; ++step) {
        if (random() % 100 < 52) {
            queue.push(&step);
            plain.push_back(step);
            if (plain.size() > most) plain.pop_front();
        } else {
            int sample = -1;
            ASSERT_EQ(queue.pop(&sample), !plain.empty());
            if (plain.empty()) continue;
            ASSERT_EQ(sample, plain.front());
            plain.pop_front();
        }
        ASSERT_EQ(queue.count(), plain.size());
        for (std::size_t place = 0; place < plain.size(); ++place)
            ASSERT_EQ(*static_cast<const int*>(queue.at(place)), plain[place]) << "seed " << seed << ", step " << step;
    }
}

}  // namespace quorient::bus
