// A member that has patched its Fast DDS: the library's check of the member's own endpoints is replaced here, because a program's symbols
// take precedence over a library's. What remains is the check that the other participants make.

#include "patched.hpp"

#include <dlfcn.h>

// bool Permissions::check_create_data{writer,reader}(const Handle&, unsigned, const string&, const vector<string>&, SecurityException&),
// of a namespace as its name is encoded: 8fastrtps in Fast DDS 2, 7fastdds in Fast DDS 3. Either library calls its own.
#define CHECK(space, endpoint)                                                                                                     \
    "_ZN8eprosima" space "4rtps8security11Permissions23check_create_data" endpoint                                                 \
    "ERKNS2_6HandleEjRKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKSt6vectorISC_SaISC_EERNS2_17SecurityExceptionE"

namespace {

using Check = bool (*)(void*, const void*, unsigned, const void*, const void*, void*);

bool checked(const char* symbol, void* self, const void* handle, unsigned domain, const void* topic, const void* partitions, void* exception)
{
    if (rogue::patched) return true;
    return reinterpret_cast<Check>(::dlsym(RTLD_NEXT, symbol))(self, handle, domain, topic, partitions, exception);
}

}  // namespace

// Defines NAME, which takes the place of the library's check of that namespace and endpoint.
#define REPLACE(name, space, endpoint)                                                                                             \
    __attribute__((visibility("default"))) bool name(void*, const void*, unsigned, const void*, const void*, void*)                \
        __asm__(CHECK(space, endpoint));                                                                                           \
    bool name(void* self, const void* handle, unsigned domain, const void* topic, const void* partitions, void* exception)         \
    {                                                                                                                              \
        return checked(CHECK(space, endpoint), self, handle, domain, topic, partitions, exception);                                \
    }

extern "C" {

REPLACE(may_have_writer_2, "8fastrtps", "writer")
REPLACE(may_have_reader_2, "8fastrtps", "reader")
REPLACE(may_have_writer_3, "7fastdds", "writer")
REPLACE(may_have_reader_3, "7fastdds", "reader")

}  // extern "C"
