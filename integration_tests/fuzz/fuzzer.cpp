// One target under libFuzzer.
#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    quorient::fuzz::QUORIENT_FUZZ_TARGET(data, size);
    return 0;
}
