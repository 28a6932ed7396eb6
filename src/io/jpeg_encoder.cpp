#include "io/jpeg_encoder.h"

#include <jpeglib.h>

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it first
#include <cstdlib>

namespace tessera {
namespace {

// libjpeg's state. libjpeg reports errors through longjmp, so the function that calls setjmp must
// hold only trivial objects.
struct Compressor {
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    std::jmp_buf on_error{};
    unsigned char* buffer = nullptr;  // allocated by libjpeg with malloc
    unsigned long size = 0;

    Compressor() {
        info.err = jpeg_std_error(&errors);
        info.client_data = this;
        errors.error_exit = [](j_common_ptr common) {
            std::longjmp(static_cast<Compressor*>(common->client_data)->on_error, 1);
        };
        errors.output_message = [](j_common_ptr) {};
    }
    ~Compressor() {
        jpeg_destroy_compress(&info);
        std::free(buffer);
    }
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;
};

bool Encode(Compressor& c, const ColourImage& image, int quality) {
    if (setjmp(c.on_error) != 0) return false;
    jpeg_create_compress(&c.info);
    jpeg_mem_dest(&c.info, &c.buffer, &c.size);
    c.info.image_width = static_cast<JDIMENSION>(image.width());
    c.info.image_height = static_cast<JDIMENSION>(image.height());
    c.info.input_components = 3;
    c.info.in_color_space = JCS_EXT_RGB;
    jpeg_set_defaults(&c.info);
    jpeg_set_quality(&c.info, quality, TRUE);
    c.info.comp_info[0].h_samp_factor = c.info.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&c.info, TRUE);
    while (c.info.next_scanline < c.info.image_height) {
        const auto* const pixels =
            image.data() + std::size_t{c.info.next_scanline} * c.info.image_width;
        JSAMPROW row = reinterpret_cast<JSAMPROW>(const_cast<Rgb8*>(pixels));  // only read
        jpeg_write_scanlines(&c.info, &row, 1);
    }
    jpeg_finish_compress(&c.info);
    return true;
}

}  // namespace

Status EncodeJpeg(const ColourImage& image, int quality, std::vector<std::uint8_t>& file) {
    TESSERA_CHECK(!image.empty(), "no pixels");
    Compressor c;
    if (!Encode(c, image, quality)) {
        char text[JMSG_LENGTH_MAX];
        c.errors.format_message(reinterpret_cast<j_common_ptr>(&c.info), text);
        return Status::Error(fmt::format("cannot be encoded as JPEG ({})", text));
    }
    file.assign(c.buffer, c.buffer + c.size);
    return Status::Ok();
}

}  // namespace tessera
