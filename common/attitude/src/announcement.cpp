#include "announcement.hpp"

#include <algorithm>

namespace quorient::attitude {

void Announcement::publish()
{
    published_ = shown_.attitude;
    unpublished_ = 0;
}

void Announcement::correct(const Standing& newest, const Quaternion& corrected, std::size_t integrated_again, bool announced)
{
    shown_ = newest;
    if (announced && corrected.coeffs() != published_.coeffs()) {
        ++reset_counter_;
        reset_rotation_ = renormalised(corrected * published_.conjugate());
        rolled_back_frames_ += static_cast<std::uint32_t>(integrated_again - std::min(integrated_again, unpublished_));
    }
    published_ = corrected;
}

void Announcement::begin(const Standing& start, bool stated)
{
    if (stated) {
        ++reset_counter_;
        reset_rotation_ = renormalised(start.attitude * shown_.attitude.conjugate());
    }
    shown_ = start;
    publish();
}

void Announcement::take_over(std::uint32_t reset_counter, const Quaternion& reset_rotation)
{
    reset_counter_ = reset_counter;
    reset_rotation_ = reset_rotation;
}

void Announcement::write(AttitudeState& state) const
{
    state.attitude = to_array(shown_.attitude);
    state.reset_rotation = to_array(reset_rotation_);
    state.reset_counter = reset_counter_;
    state.rolled_back_frames = rolled_back_frames_;
}

}  // namespace quorient::attitude
