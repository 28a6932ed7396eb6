#include "io/klg_frame.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>

#include "io/image_decoder.h"
#include "io/jpeg_decoder.h"

namespace tessera {

bool KlgHeader::Fits(const PinholeCamera& camera) const {
    constexpr std::int64_t kHeaders = 65536;
    const std::int64_t pixels = std::int64_t{camera.width} * camera.height;
    return depth_bytes > 0 && depth_bytes <= pixels * 2 + pixels / 8 + kHeaders &&
           colour_bytes >= 0 && colour_bytes <= pixels * 6 + kHeaders;
}

KlgFrameDecoder::KlgFrameDecoder(const CameraCalibration& calibration, const Options& options)
    : camera_(calibration.pinhole),
      swap_red_blue_(options.swap_red_blue),
      rectifier_(calibration, {.correct_distortion = options.correct_distortion}),
      inflater_(libdeflate_alloc_decompressor()) {}

KlgFrameDecoder::~KlgFrameDecoder() = default;

void KlgFrameDecoder::FreeInflater::operator()(libdeflate_decompressor* inflater) const {
    libdeflate_free_decompressor(inflater);
}

Status KlgFrameDecoder::Decode(std::span<const std::uint8_t> bytes, std::int32_t depth_bytes,
                               Frame& frame) {
    if (Status status = Decode(bytes, depth_bytes); !status.ok()) return status;
    rectifier_.Fill(depth_, colour_, frame);
    return Status::Ok();
}

Status KlgFrameDecoder::Decode(std::span<const std::uint8_t> bytes, std::int32_t depth_bytes) {
    const auto split = static_cast<std::size_t>(depth_bytes);
    if (Status status = DecodeDepth(bytes.first(split)); !status.ok()) return status;
    return DecodeColour(bytes.subspan(split));
}

Status KlgFrameDecoder::DecodeDepth(std::span<const std::uint8_t> bytes) {
    depth_.Resize(camera_.width, camera_.height);
    const std::size_t size = depth_.size() * sizeof(std::uint16_t);
    if (bytes.size() == size) {
        std::memcpy(depth_.data(), bytes.data(), size);
        return Status::Ok();
    }
    if (libdeflate_zlib_decompress(inflater_.get(), bytes.data(), bytes.size(), depth_.data(), size,
                                   nullptr) != LIBDEFLATE_SUCCESS)
        return Status::Error(
            fmt::format("depth is damaged, or its size is not {} x {} pixels (set the size in "
                        "camera.yaml)",
                        camera_.width, camera_.height));
    return Status::Ok();
}

Status KlgFrameDecoder::DecodeColour(std::span<const std::uint8_t> bytes) {
    colour_.Resize(bytes.empty() ? 0 : camera_.width, bytes.empty() ? 0 : camera_.height);
    if (bytes.size() == colour_.size() * sizeof(Rgb8)) {
        if (!bytes.empty()) std::memcpy(colour_.data(), bytes.data(), bytes.size());
    } else if (Status status = DecodeCompressed(bytes); !status.ok()) {
        return Status::Error("colour " + status.message());
    }
    if (swap_red_blue_)
        std::for_each_n(colour_.data(), colour_.size(), [](Rgb8& c) { std::swap(c.r, c.b); });
    return Status::Ok();
}

Status KlgFrameDecoder::DecodeCompressed(std::span<const std::uint8_t> bytes) {
    const auto size = ReadJpegSize(bytes);
    if (size && *size != ImageSize{camera_.width, camera_.height})
        return Status::Error(
            fmt::format("has {} x {} pixels, but the camera has {} x {}; correct camera.yaml",
                        size->width, size->height, camera_.width, camera_.height));
    return DecodeJpeg(bytes, ImageDecoder::kMaxSide_px, colour_);
}

}  // namespace tessera
