#include "viewer_messages.hpp"

#include "quorient/messages/time.hpp"
#include "ros2_messages.hpp"

#include <fmt/format.h>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string_view>

namespace quorient::record {

namespace {

constexpr std::string_view reference_frame = "reference";
constexpr std::string_view body_frame = "body";

/// Plain little-endian CDR: each number stands at a multiple of its size, counted behind the four bytes in front.
class Cdr {
public:
    explicit Cdr(std::vector<std::uint8_t>& bytes) : bytes_(bytes) { bytes_.assign({0, 1, 0, 0}); }

    template <class Number>
    void number(Number value)
    {
        while ((bytes_.size() - 4) % sizeof value != 0) bytes_.push_back(0);
        const auto* const image = reinterpret_cast<const std::uint8_t*>(&value);
        bytes_.insert(bytes_.end(), image, image + sizeof value);
    }

    template <std::size_t Size>
    void numbers(const std::array<double, Size>& values)
    {
        for (const double value : values) number(value);
    }

    void text(std::string_view value)
    {
        number(static_cast<std::uint32_t>(value.size() + 1));
        bytes_.insert(bytes_.end(), value.begin(), value.end());
        bytes_.push_back(0);
    }

private:
    std::vector<std::uint8_t>& bytes_;
};

}  // namespace

void ViewerMessages::make(const VotedAttitude& voted, std::uint64_t time_ns)
{
    const auto imu = voter::to_imu(voted, voter::rate_covariance(description_, voted.used_mask));
    const auto& [w, x, y, z] = imu.orientation;
    Cdr cdr(imu_);
    cdr.number(static_cast<std::int32_t>(time_ns / second_ns));
    cdr.number(static_cast<std::uint32_t>(time_ns % second_ns));
    cdr.text(body_frame);
    cdr.numbers(std::array{x, y, z, w});
    cdr.numbers(imu.orientation_covariance);
    cdr.numbers(imu.rate_rad_s);
    cdr.numbers(imu.rate_covariance);
    cdr.numbers(imu.acceleration_m_s2);
    cdr.numbers(imu.acceleration_covariance);

    transform_.clear();
    const bool known = imu.orientation_covariance[0] >= 0 && std::isfinite(w + x + y + z);
    if (!known) return;
    fmt::format_to(std::back_inserter(transform_),
                   R"({{"timestamp":{{"sec":{},"nsec":{}}},"parent_frame_id":"{}","child_frame_id":"{}",)"
                   R"("translation":{{"x":0,"y":0,"z":0}},"rotation":{{"x":{},"y":{},"z":{},"w":{}}}}})",
                   time_ns / second_ns, time_ns % second_ns, reference_frame, body_frame, x, y, z, w);
}

}  // namespace quorient::record
