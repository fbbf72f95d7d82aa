#include "../src/types.hpp"

#include <gtest/gtest.h>

namespace quorient::bus {

namespace {

TEST(CycloneTypes, are_of_fixed_size)
{
    for (std::size_t type = 0; type < type_count; ++type) {
        const auto& descriptor = cyclonedds::descriptor_of(static_cast<TypeId>(type));
        EXPECT_NE(descriptor.m_flagset & DDS_TOPIC_FIXED_SIZE, 0U) << descriptor.m_typename;
    }
}

}  // namespace

}  // namespace quorient::bus
