#include "byte_source.hpp"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>
#include <algorithm>

namespace quorient::recording {
namespace {

constexpr std::size_t buffer_size = 1U << 16U;
constexpr int largest_window_log = 27;  // 128 MiB is zstd's own default limit of what a decoder accepts

/// One call of a decoder: how much it took and gave.
struct Progressed {
    std::size_t taken = 0;
    std::size_t given = 0;
    bool frame_ended = false;  ///< a member or frame is complete; another may follow
    std::string trouble;
};

class GzipDecoder {
public:
    static constexpr std::string_view name = "gzip";

    GzipDecoder() { ::inflateInit2(&stream_, 15 + 16); }  // the largest window, gzip's frame
    ~GzipDecoder() { ::inflateEnd(&stream_); }
    GzipDecoder(const GzipDecoder&) = delete;
    GzipDecoder& operator=(const GzipDecoder&) = delete;

    void reset() { ::inflateReset(&stream_); }

    Progressed decode(Bytes from, std::span<std::uint8_t> into)
    {
        stream_.next_in = const_cast<Bytef*>(from.data());  // zlib reads through it and does not write
        stream_.avail_in = static_cast<uInt>(from.size());
        stream_.next_out = into.data();
        stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(into.size(), 1U << 30U));
        const uInt room = stream_.avail_out;
        const int result = ::inflate(&stream_, Z_NO_FLUSH);
        Progressed done{from.size() - stream_.avail_in, room - stream_.avail_out, result == Z_STREAM_END, {}};
        if (result == Z_STREAM_END) reset();
        else if (result != Z_OK && result != Z_BUF_ERROR) done.trouble = stream_.msg != nullptr ? stream_.msg : "bad data";
        return done;
    }

private:
    z_stream stream_{};
};

class ZstdDecoder {
public:
    static constexpr std::string_view name = "zstd";

    ZstdDecoder() : context_(ZSTD_createDCtx(), ZSTD_freeDCtx)
    {
        ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, largest_window_log);
    }

    void reset() { ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_only); }

    Progressed decode(Bytes from, std::span<std::uint8_t> into)
    {
        ZSTD_inBuffer in{from.data(), from.size(), 0};
        ZSTD_outBuffer out{into.data(), into.size(), 0};
        const std::size_t result = ZSTD_decompressStream(context_.get(), &out, &in);
        if (ZSTD_isError(result) != 0) return {in.pos, out.pos, false, ZSTD_getErrorName(result)};
        return {in.pos, out.pos, result == 0, {}};
    }

private:
    std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context_;
};

class Lz4Decoder {
public:
    static constexpr std::string_view name = "lz4";

    Lz4Decoder() { LZ4F_createDecompressionContext(&context_, LZ4F_VERSION); }
    ~Lz4Decoder() { LZ4F_freeDecompressionContext(context_); }
    Lz4Decoder(const Lz4Decoder&) = delete;
    Lz4Decoder& operator=(const Lz4Decoder&) = delete;

    void reset() { LZ4F_resetDecompressionContext(context_); }

    Progressed decode(Bytes from, std::span<std::uint8_t> into)
    {
        std::size_t given = into.size();
        std::size_t taken = from.size();
        const std::size_t result = LZ4F_decompress(context_, into.data(), &given, from.data(), &taken, nullptr);
        if (LZ4F_isError(result) != 0) return {taken, given, false, LZ4F_getErrorName(result)};
        return {taken, given, result == 0, {}};
    }

private:
    LZ4F_dctx* context_ = nullptr;
};

template <class Decoder>
class CompressedSource final : public ByteSource {
public:
    explicit CompressedSource(std::unique_ptr<ByteSource> compressed) : compressed_(std::move(compressed)), buffer_(buffer_size) {}

    std::size_t read(std::span<std::uint8_t> into) override
    {
        std::size_t count = 0;
        while (count < into.size() && trouble_.empty()) {
            const bool more = begin_ < end_ || refill();
            const auto done = decoder_.decode(Bytes(buffer_).subspan(begin_, end_ - begin_), into.subspan(count));
            begin_ += done.taken;
            taken_ += done.taken;
            count += done.given;
            if (done.taken > 0 || done.given > 0) inside_ = !done.frame_ended;
            if (!done.trouble.empty()) trouble_ = fmt::format("{}: {} (compressed byte {})", Decoder::name, done.trouble, taken_);
            if (!more && done.given == 0) break;
            if (trouble_.empty() && done.taken == 0 && done.given == 0)
                trouble_ = fmt::format("the {} data leads nowhere at its byte {}", Decoder::name, taken_);
        }
        if (count < into.size() && trouble_.empty() && !compressed_->trouble().empty()) trouble_ = compressed_->trouble();
        if (count < into.size() && trouble_.empty() && inside_)
            trouble_ = fmt::format("the {} data is cut at its byte {}", Decoder::name, taken_);
        return count;
    }

    void rewind() override
    {
        compressed_->rewind();
        decoder_.reset();
        begin_ = end_ = 0;
        taken_ = 0;
        inside_ = false;
        trouble_.clear();
    }

    double progress() const override { return compressed_->progress(); }

private:
    bool refill()
    {
        begin_ = 0;
        end_ = compressed_->read(buffer_);
        return end_ > 0;
    }

    std::unique_ptr<ByteSource> compressed_;
    Decoder decoder_;
    std::vector<std::uint8_t> buffer_;
    std::size_t begin_ = 0;  // start of what is not decoded yet
    std::size_t end_ = 0;
    std::uint64_t taken_ = 0;  // compressed bytes decoded
    bool inside_ = false;      // a frame is begun and not complete
};

}  // namespace

std::unique_ptr<ByteSource> gzip_source(std::unique_ptr<ByteSource> compressed)
{
    return std::make_unique<CompressedSource<GzipDecoder>>(std::move(compressed));
}

std::unique_ptr<ByteSource> zstd_source(std::unique_ptr<ByteSource> compressed)
{
    return std::make_unique<CompressedSource<ZstdDecoder>>(std::move(compressed));
}

std::unique_ptr<ByteSource> lz4_source(std::unique_ptr<ByteSource> compressed)
{
    return std::make_unique<CompressedSource<Lz4Decoder>>(std::move(compressed));
}

}  // namespace quorient::recording
