#include "ros2.hpp"

#include "quorient/bus/ros2.hpp"

#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"
#include "ros2_msgsPubSubTypes.hpp"
#include "tolerant_type.hpp"

#include <algorithm>
#include <cstring>

namespace quorient::bus::fastdds {

namespace {

using VendorImu = sensor_msgs::msg::dds_::Imu_;
using VendorDiagnostics = diagnostic_msgs::msg::dds_::DiagnosticArray_;

/// Times before 1970 have a negative second and a positive rest.
void put(std::int64_t stamp_ns, builtin_interfaces::msg::dds_::Time_& time)
{
    const std::int64_t rest = (stamp_ns % second_ns + second_ns) % second_ns;
    time.sec_(static_cast<std::int32_t>((stamp_ns - rest) / second_ns));
    time.nanosec_(static_cast<std::uint32_t>(rest));
}

std::int64_t stamp_of(const builtin_interfaces::msg::dds_::Time_& time)
{
    return time.sec_() * second_ns + time.nanosec_();
}

template <std::size_t Size>
std::string text(const Name<Size>& name)
{
    return {name.data(), ::strnlen(name.data(), Size)};
}

void to_vendor(const ros2::Imu& imu, VendorImu& sample)
{
    put(imu.stamp_ns, sample.header_().stamp_());
    sample.header_().frame_id_(text(imu.frame_id));
    sample.orientation_().w_(imu.orientation[0]);
    sample.orientation_().x_(imu.orientation[1]);
    sample.orientation_().y_(imu.orientation[2]);
    sample.orientation_().z_(imu.orientation[3]);
    sample.orientation_covariance_(imu.orientation_covariance);
    sample.angular_velocity_().x_(imu.rate_rad_s[0]);
    sample.angular_velocity_().y_(imu.rate_rad_s[1]);
    sample.angular_velocity_().z_(imu.rate_rad_s[2]);
    sample.angular_velocity_covariance_(imu.rate_covariance);
    sample.linear_acceleration_().x_(imu.acceleration_m_s2[0]);
    sample.linear_acceleration_().y_(imu.acceleration_m_s2[1]);
    sample.linear_acceleration_().z_(imu.acceleration_m_s2[2]);
    sample.linear_acceleration_covariance_(imu.acceleration_covariance);
}

void from_vendor(const VendorImu& sample, ros2::Imu& imu)
{
    const auto& q = sample.orientation_();
    const auto& rate = sample.angular_velocity_();
    const auto& acceleration = sample.linear_acceleration_();
    imu.stamp_ns = stamp_of(sample.header_().stamp_());
    copy_text(sample.header_().frame_id_(), imu.frame_id);
    imu.orientation = {q.w_(), q.x_(), q.y_(), q.z_()};
    imu.orientation_covariance = sample.orientation_covariance_();
    imu.rate_rad_s = {rate.x_(), rate.y_(), rate.z_()};
    imu.rate_covariance = sample.angular_velocity_covariance_();
    imu.acceleration_m_s2 = {acceleration.x_(), acceleration.y_(), acceleration.z_()};
    imu.acceleration_covariance = sample.linear_acceleration_covariance_();
}

void to_vendor(const ros2::DiagnosticArray& array, VendorDiagnostics& sample)
{
    put(array.stamp_ns, sample.header_().stamp_());
    sample.status_().resize(array.count);
    for (std::size_t i = 0; i < array.count; ++i) {
        const auto& status = array.status[i];
        auto& theirs = sample.status_()[i];
        theirs.level_(status.level);
        theirs.name_(text(status.name));
        theirs.message_(text(status.message));
        theirs.hardware_id_(text(status.hardware_id));
        theirs.values_().resize(status.value_count);
        for (std::size_t j = 0; j < status.value_count; ++j) {
            theirs.values_()[j].key_(text(status.values[j].key));
            theirs.values_()[j].value_(text(status.values[j].value));
        }
    }
}

void from_vendor(const VendorDiagnostics& sample, ros2::DiagnosticArray& array)
{
    array.stamp_ns = stamp_of(sample.header_().stamp_());
    array.count = static_cast<std::uint32_t>(std::min(sample.status_().size(), ros2::max_diagnostics));
    for (std::size_t i = 0; i < array.count; ++i) {
        const auto& theirs = sample.status_()[i];
        auto& status = array.status[i];
        status.level = theirs.level_();
        copy_text(theirs.name_(), status.name);
        copy_text(theirs.message_(), status.message);
        copy_text(theirs.hardware_id_(), status.hardware_id);
        status.value_count = static_cast<std::uint32_t>(std::min(theirs.values_().size(), status.values.size()));
        for (std::size_t j = 0; j < status.value_count; ++j) {
            copy_text(theirs.values_()[j].key_(), status.values[j].key);
            copy_text(theirs.values_()[j].value_(), status.values[j].value);
        }
    }
}

}  // namespace

bool is_ros2(TypeId type)
{
    return type == TypeId::ros2_imu || type == TypeId::ros2_diagnostics;
}

eprosima::fastdds::dds::TypeSupport ros2_type_support_of(TypeId type)
{
    using eprosima::fastdds::dds::TypeSupport;
    if (type == TypeId::ros2_imu) return TypeSupport{new TolerantType<sensor_msgs::msg::dds_::Imu_PubSubType>};
    return TypeSupport{new TolerantType<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>};
}

void ros2_to_vendor(TypeId type, const void* message, void* sample)
{
    if (type == TypeId::ros2_imu) to_vendor(*static_cast<const ros2::Imu*>(message), *static_cast<VendorImu*>(sample));
    else to_vendor(*static_cast<const ros2::DiagnosticArray*>(message), *static_cast<VendorDiagnostics*>(sample));
}

void ros2_from_vendor(TypeId type, const void* sample, void* message)
{
    if (type == TypeId::ros2_imu) from_vendor(*static_cast<const VendorImu*>(sample), *static_cast<ros2::Imu*>(message));
    else from_vendor(*static_cast<const VendorDiagnostics*>(sample), *static_cast<ros2::DiagnosticArray*>(message));
}

}  // namespace quorient::bus::fastdds
