#include "openssl.hpp"

#include <array>
#include <stdexcept>

namespace quorient::security {

void must(bool done, const char* what)
{
    if (done) return;
    std::array<char, 256> reason{};
    ERR_error_string_n(ERR_get_error(), reason.data(), reason.size());
    ERR_clear_error();
    throw std::runtime_error(std::string{"OpenSSL: "} + what + ": " + reason.data());
}

Bio memory()
{
    return must(Bio{BIO_new(BIO_s_mem())}, "memory");
}

Bio memory(const std::string& content)
{
    return must(Bio{BIO_new_mem_buf(content.data(), static_cast<int>(content.size()))}, "memory");
}

std::string content_of(BIO& stream)
{
    char* data = nullptr;
    const long size = BIO_get_mem_data(&stream, &data);
    return {data, static_cast<std::size_t>(size)};
}

}  // namespace quorient::security
