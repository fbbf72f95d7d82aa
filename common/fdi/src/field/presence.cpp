#include "field/presence.hpp"

#include <algorithm>

namespace quorient::fdi::field {
namespace {

constexpr std::uint32_t silent_for = 0b11111;  ///< five frames in a row without data
constexpr int missing_of_32 = 8;
constexpr std::uint32_t run_to_return = 5;

}  // namespace

void Presence::update(InstrumentSet present)
{
    for (std::size_t m = 0; m < count_; ++m) {
        const bool here = present.has(m);
        missing_[m] = (missing_[m] << 1) | (here ? 0U : 1U);
        run_[m] = here ? std::min(run_[m] + 1, run_to_return) : 0;
        silent_[m] = here ? 0 : silent_[m] + 1;
        if (delivering_.has(m)) {
            const bool silent = (missing_[m] & silent_for) == silent_for;
            if (silent || std::popcount(missing_[m]) > missing_of_32) delivering_.remove(m);
        } else if (run_[m] >= run_to_return) {
            missing_[m] = 0;
            delivering_.add(m);
        }
    }
}

void Presence::reset()
{
    *this = Presence(count_);
}

}  // namespace quorient::fdi::field
