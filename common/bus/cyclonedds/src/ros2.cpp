#include "ros2.hpp"

#include "quorient/bus/ros2.hpp"

#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"
#include "ros2_msgs.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace quorient::bus::cyclonedds {

namespace {

/// Times before 1970 have a negative second and a positive rest.
void put(std::int64_t stamp_ns, builtin_interfaces_msg_dds__Time_& time)
{
    const std::int64_t rest = (stamp_ns % second_ns + second_ns) % second_ns;
    time.sec_ = static_cast<std::int32_t>((stamp_ns - rest) / second_ns);
    time.nanosec_ = static_cast<std::uint32_t>(rest);
}

template <std::size_t Size>
char* text(const Name<Size>& name)
{
    return const_cast<char*>(name.data());  // Cyclone only reads it
}

template <std::size_t Size>
void get(const char* text, Name<Size>& name)
{
    copy_text(text ? std::string_view(text, strnlen(text, Size)) : std::string_view(), name);
}

sensor_msgs_msg_dds__Imu_ to_vendor(const ros2::Imu& imu)
{
    sensor_msgs_msg_dds__Imu_ sample{};
    put(imu.stamp_ns, sample.header_.stamp_);
    sample.header_.frame_id_ = text(imu.frame_id);
    sample.orientation_ = {.x_ = imu.orientation[1], .y_ = imu.orientation[2], .z_ = imu.orientation[3], .w_ = imu.orientation[0]};
    sample.angular_velocity_ = {imu.rate_rad_s[0], imu.rate_rad_s[1], imu.rate_rad_s[2]};
    sample.linear_acceleration_ = {imu.acceleration_m_s2[0], imu.acceleration_m_s2[1], imu.acceleration_m_s2[2]};
    std::ranges::copy(imu.orientation_covariance, sample.orientation_covariance_);
    std::ranges::copy(imu.rate_covariance, sample.angular_velocity_covariance_);
    std::ranges::copy(imu.acceleration_covariance, sample.linear_acceleration_covariance_);
    return sample;
}

void from_vendor(const sensor_msgs_msg_dds__Imu_& sample, ros2::Imu& imu)
{
    imu.stamp_ns = sample.header_.stamp_.sec_ * second_ns + sample.header_.stamp_.nanosec_;
    get(sample.header_.frame_id_, imu.frame_id);
    imu.orientation = {sample.orientation_.w_, sample.orientation_.x_, sample.orientation_.y_, sample.orientation_.z_};
    imu.rate_rad_s = {sample.angular_velocity_.x_, sample.angular_velocity_.y_, sample.angular_velocity_.z_};
    imu.acceleration_m_s2 = {sample.linear_acceleration_.x_, sample.linear_acceleration_.y_, sample.linear_acceleration_.z_};
    std::ranges::copy(sample.orientation_covariance_, imu.orientation_covariance.begin());
    std::ranges::copy(sample.angular_velocity_covariance_, imu.rate_covariance.begin());
    std::ranges::copy(sample.linear_acceleration_covariance_, imu.acceleration_covariance.begin());
}

bool write(dds_entity_t writer, const ros2::DiagnosticArray& array)
{
    std::vector<std::vector<diagnostic_msgs_msg_dds__KeyValue_>> values(array.count);
    std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> statuses(array.count);
    for (std::size_t i = 0; i < array.count; ++i) {
        const auto& status = array.status[i];
        for (std::size_t j = 0; j < status.value_count; ++j)
            values[i].push_back({text(status.values[j].key), text(status.values[j].value)});
        statuses[i] = {.level_ = status.level,
                       .name_ = text(status.name),
                       .message_ = text(status.message),
                       .hardware_id_ = text(status.hardware_id),
                       .values_ = {status.value_count, status.value_count, values[i].data(), false}};
    }
    diagnostic_msgs_msg_dds__DiagnosticArray_ sample{};
    char no_frame[] = "";
    put(array.stamp_ns, sample.header_.stamp_);
    sample.header_.frame_id_ = no_frame;
    sample.status_ = {array.count, array.count, statuses.data(), false};
    return dds_write(writer, &sample) == DDS_RETCODE_OK;
}

void from_vendor(const diagnostic_msgs_msg_dds__DiagnosticArray_& sample, ros2::DiagnosticArray& array)
{
    array.stamp_ns = sample.header_.stamp_.sec_ * second_ns + sample.header_.stamp_.nanosec_;
    array.count = std::min<std::uint32_t>(sample.status_._length, ros2::max_diagnostics);
    for (std::size_t i = 0; i < array.count; ++i) {
        const auto& theirs = sample.status_._buffer[i];
        auto& status = array.status[i];
        status.level = theirs.level_;
        get(theirs.name_, status.name);
        get(theirs.message_, status.message);
        get(theirs.hardware_id_, status.hardware_id);
        status.value_count = std::min<std::uint32_t>(theirs.values_._length, static_cast<std::uint32_t>(status.values.size()));
        for (std::size_t j = 0; j < status.value_count; ++j) {
            get(theirs.values_._buffer[j].key_, status.values[j].key);
            get(theirs.values_._buffer[j].value_, status.values[j].value);
        }
    }
}

template <class Sample, class Message>
bool take(dds_entity_t reader, Message& message)
{
    void* loan[1] = {nullptr};
    dds_sample_info_t info{};
    bool valid = false;
    while (!valid && dds_take(reader, loan, &info, 1, 1) == 1) {
        valid = info.valid_data;
        if (valid) from_vendor(*static_cast<const Sample*>(loan[0]), message);
        dds_return_loan(reader, loan, 1);
        loan[0] = nullptr;
    }
    return valid;
}

}  // namespace

bool is_ros2(TypeId type)
{
    return type == TypeId::ros2_imu || type == TypeId::ros2_diagnostics;
}

const dds_topic_descriptor_t& ros2_descriptor_of(TypeId type)
{
    return type == TypeId::ros2_imu ? sensor_msgs_msg_dds__Imu__desc : diagnostic_msgs_msg_dds__DiagnosticArray__desc;
}

bool write_ros2(TypeId type, dds_entity_t writer, const void* message)
{
    if (type == TypeId::ros2_diagnostics) return write(writer, *static_cast<const ros2::DiagnosticArray*>(message));
    const auto sample = to_vendor(*static_cast<const ros2::Imu*>(message));
    return dds_write(writer, &sample) == DDS_RETCODE_OK;
}

bool take_ros2(TypeId type, dds_entity_t reader, void* message)
{
    if (type == TypeId::ros2_diagnostics)
        return take<diagnostic_msgs_msg_dds__DiagnosticArray_>(reader, *static_cast<ros2::DiagnosticArray*>(message));
    return take<sensor_msgs_msg_dds__Imu_>(reader, *static_cast<ros2::Imu*>(message));
}

}  // namespace quorient::bus::cyclonedds
