// A member that has patched its Fast DDS: the library's check of the member's own endpoints is replaced here, because a program's symbols
// take precedence over a library's. What remains is the check that the other participants make.

#include "patched.hpp"

#include <dlfcn.h>

// bool Permissions::check_create_data{writer,reader}(const Handle&, unsigned, const string&, const vector<string>&, SecurityException&)
#define CHECK(endpoint)                                                                                                            \
    "_ZN8eprosima8fastrtps4rtps8security11Permissions23check_create_data" endpoint                                                 \
    "ERKNS2_6HandleEjRKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKSt6vectorISC_SaISC_EERNS2_17SecurityExceptionE"

namespace {

using Check = bool (*)(void*, const void*, unsigned, const void*, const void*, void*);

bool checked(const char* symbol, void* self, const void* handle, unsigned domain, const void* topic, const void* partitions, void* exception)
{
    if (rogue::patched) return true;
    return reinterpret_cast<Check>(::dlsym(RTLD_NEXT, symbol))(self, handle, domain, topic, partitions, exception);
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) bool may_have_writer(void* self, const void* handle, unsigned domain, const void* topic,
                                                            const void* partitions, void* exception) __asm__(CHECK("writer"));
bool may_have_writer(void* self, const void* handle, unsigned domain, const void* topic, const void* partitions, void* exception)
{
    return checked(CHECK("writer"), self, handle, domain, topic, partitions, exception);
}

__attribute__((visibility("default"))) bool may_have_reader(void* self, const void* handle, unsigned domain, const void* topic,
                                                            const void* partitions, void* exception) __asm__(CHECK("reader"));
bool may_have_reader(void* self, const void* handle, unsigned domain, const void* topic, const void* partitions, void* exception)
{
    return checked(CHECK("reader"), self, handle, domain, topic, partitions, exception);
}

}  // extern "C"
