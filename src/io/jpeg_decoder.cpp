#include "io/jpeg_decoder.h"

#include <jerror.h>
#include <jpeglib.h>

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it first

namespace tessera {
namespace {

constexpr int kMostScans = 100;  // usual progressive images have ten

static_assert(sizeof(Rgb8) == 3, "decoded rows are written in place");

// libjpeg's state. libjpeg reports errors through longjmp, so the functions that call setjmp must
// hold only trivial objects.
struct Decompressor {
    jpeg_decompress_struct info{};
    jpeg_error_mgr errors{};
    std::jmp_buf on_error{};
    bool too_many_scans = false;
    int damage = 0;  // code of the first warning that means lost pixels

    Decompressor() {
        info.err = jpeg_std_error(&errors);
        info.client_data = this;
        errors.error_exit = [](j_common_ptr common) {
            std::longjmp(static_cast<Decompressor*>(common->client_data)->on_error, 1);
        };
        errors.emit_message = [](j_common_ptr common, int level) {
            const int code = common->err->msg_code;
            const bool harmless =
                code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR || code == JWRN_ADOBE_XFORM;
            auto* self = static_cast<Decompressor*>(common->client_data);
            if (level < 0 && !harmless && self->damage == 0) self->damage = code;
        };
        errors.output_message = [](j_common_ptr) {};
    }
    ~Decompressor() { jpeg_destroy_decompress(&info); }
    Decompressor(const Decompressor&) = delete;
    Decompressor& operator=(const Decompressor&) = delete;

    Status LastError() {
        if (too_many_scans)
            return Status::Error(fmt::format("has more than {} scans; save it again", kMostScans));
        char text[JMSG_LENGTH_MAX];
        if (damage != 0) errors.msg_code = damage;
        errors.format_message(reinterpret_cast<j_common_ptr>(&info), text);
        return Status::Error(fmt::format("is truncated or damaged ({})", text));
    }
};

bool ReadHeader(Decompressor& d, std::span<const std::uint8_t> file) {
    if (setjmp(d.on_error) != 0) return false;
    jpeg_create_decompress(&d.info);
    jpeg_mem_src(&d.info, file.data(), static_cast<unsigned long>(file.size()));
    jpeg_read_header(&d.info, TRUE);
    return true;
}

// `pixels` must have room for the image's width x height.
bool ReadRows(Decompressor& d, Rgb8* pixels) {
    if (setjmp(d.on_error) != 0) return false;
    d.info.out_color_space = JCS_EXT_RGB;
    jpeg_progress_mgr progress{};
    progress.progress_monitor = [](j_common_ptr common) {
        auto* self = static_cast<Decompressor*>(common->client_data);
        if (self->info.input_scan_number <= kMostScans) return;
        self->too_many_scans = true;
        std::longjmp(self->on_error, 1);
    };
    d.info.progress = &progress;
    jpeg_start_decompress(&d.info);
    while (d.info.output_scanline < d.info.output_height) {
        constexpr JDIMENSION kRows = 8;
        JSAMPROW rows[kRows];
        const JDIMENSION left = d.info.output_height - d.info.output_scanline;
        const JDIMENSION count = left < kRows ? left : kRows;
        for (JDIMENSION i = 0; i < count; ++i)
            rows[i] = reinterpret_cast<JSAMPROW>(
                pixels +
                static_cast<std::size_t>(d.info.output_scanline + i) * d.info.output_width);
        jpeg_read_scanlines(&d.info, rows, count);
    }
    jpeg_finish_decompress(&d.info);
    return true;
}

}  // namespace

std::optional<ImageSize> ReadJpegSize(std::span<const std::uint8_t> file) {
    Decompressor d;
    if (!ReadHeader(d, file) || d.info.image_width == 0 || d.info.image_height == 0)
        return std::nullopt;
    return ImageSize{static_cast<int>(d.info.image_width), static_cast<int>(d.info.image_height)};
}

bool IsJpeg(std::span<const std::uint8_t> file) {
    return file.size() >= 3 && file[0] == 0xff && file[1] == 0xd8 && file[2] == 0xff;
}

Status DecodeJpeg(std::span<const std::uint8_t> file, int max_side_px, ColourImage& image) {
    Decompressor d;
    if (!ReadHeader(d, file)) return d.LastError();
    const JDIMENSION width = d.info.image_width, height = d.info.image_height;
    const auto limit = static_cast<JDIMENSION>(max_side_px);
    if (width > limit || height > limit)
        return Status::Error(fmt::format("{} x {} pixels; at most {} per side are supported", width,
                                         height, max_side_px));
    image.Resize(static_cast<int>(width), static_cast<int>(height));
    if (!ReadRows(d, image.data()) || d.damage != 0) return d.LastError();
    return Status::Ok();
}

}  // namespace tessera
