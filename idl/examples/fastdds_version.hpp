#pragma once
// What a plain node must know of Fast DDS's releases: 2.9 (Debian 12) and 3.1 (Debian 13) name these things differently.
#if __has_include(<fastrtps/fastrtps_dll.h>)
#include <fastdds/rtps/common/Time_t.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/types/TypesBase.h>
#include <fastrtps/utils/IPFinder.h>
#include <fastrtps/utils/IPLocator.h>

namespace fastdds_version {

namespace rtps = eprosima::fastrtps::rtps;  // addresses and how they are found
using Duration = eprosima::fastrtps::Duration_t;

inline bool is_ok(eprosima::fastrtps::types::ReturnCode_t code) { return code == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK; }

}  // namespace fastdds_version
#else
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/dds/core/Time_t.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/utils/IPFinder.hpp>
#include <fastdds/utils/IPLocator.hpp>

namespace fastdds_version {

namespace rtps = eprosima::fastdds::rtps;  // addresses and how they are found
using Duration = eprosima::fastdds::dds::Duration_t;

inline bool is_ok(eprosima::fastdds::dds::ReturnCode_t code) { return code == eprosima::fastdds::dds::RETCODE_OK; }

}  // namespace fastdds_version
#endif
