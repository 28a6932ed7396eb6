#include "recordings/sens_recording.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <cstring>
#include <new>
#include <span>

#include "io/image_decoder.h"
#include "io/jpeg_decoder.h"
#include "io/png_decoder.h"
#include "recordings/sens_index.h"

namespace tessera {
namespace {

using SensBytes = std::span<const std::uint8_t>;

class SensRecording : public Recording {
  public:
    SensRecording(InputFile file, SensIndex index)
        : file_(std::move(file)),
          index_(std::move(index)),
          inflater_(libdeflate_alloc_decompressor(), libdeflate_free_decompressor) {}

    const RecordingInfo& info() const override { return index_.info; }

    Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
        TESSERA_CHECK(index < index_.frames.size(), "frame {} of {}", index, index_.frames.size());
        try {
            return LoadFrame(index_.frames[index], depth, colour);
        } catch (const std::bad_alloc&) {
            return Status::Error("does not fit in memory");
        }
    }

  private:
    Status LoadFrame(const SensFrame& frame, Image<std::uint16_t>& depth, ColourImage& colour) {
        bytes_.resize(std::size_t{frame.colour_bytes} + frame.depth_bytes);
        if (!file_.ReadAt(frame.offset, bytes_).ok())
            return Status::Error("cannot be read; the file became shorter meanwhile");
        const SensBytes bytes = bytes_;
        if (Status status = DecodeDepth(bytes.subspan(frame.colour_bytes), depth); !status.ok())
            return Status::Error("depth " + status.message());
        Status status = DecodeColour(bytes.first(frame.colour_bytes), colour);
        return status.ok() ? status : Status::Error("colour " + status.message());
    }

    Status DecodeDepth(SensBytes bytes, Image<std::uint16_t>& depth) {
        const PinholeCamera& camera = index_.info.depth_camera.pinhole;
        depth.Resize(camera.width, camera.height);
        const std::size_t size = depth.size() * sizeof(std::uint16_t);
        if (index_.depth == SensDepth::kRaw) return Copy(bytes, depth.data(), size);
        if (!inflater_ ||
            libdeflate_zlib_decompress(inflater_.get(), bytes.data(), bytes.size(), depth.data(),
                                       size, nullptr) != LIBDEFLATE_SUCCESS)
            return Status::Error(
                fmt::format("is damaged, or not of {} x {} pixels", camera.width, camera.height));
        return {};
    }

    Status DecodeColour(SensBytes bytes, ColourImage& colour) {
        const PinholeCamera& camera = index_.info.colour_camera.pinhole;
        if (!index_.has_colour || bytes.empty()) {
            colour.Resize(0, 0);
            return {};
        }
        if (index_.colour == SensColour::kRaw) {
            colour.Resize(camera.width, camera.height);
            return Copy(bytes, colour.data(), colour.size() * sizeof(Rgb8));
        }
        const auto png = ReadPngHeader(bytes);
        const auto size = png             ? ImageSize{png->width, png->height}
                          : IsJpeg(bytes) ? ReadJpegSize(bytes).value_or(ImageSize{})
                                          : ImageSize{};
        if (size != ImageSize{camera.width, camera.height})
            return Status::Error(fmt::format("is no JPEG or PNG image of {} x {} pixels",
                                             camera.width, camera.height));
        if (!png) return DecodeJpeg(bytes, ImageDecoder::kMaxSide_px, colour);
        if (!png->common()) return Status::Error("is an interlaced PNG, or one with a palette");
        return png_.DecodeColour(bytes, *png, colour);
    }

    static Status Copy(SensBytes bytes, void* to, std::size_t size) {
        if (bytes.size() != size)
            return Status::Error(fmt::format("has {} bytes instead of {}", bytes.size(), size));
        std::memcpy(to, bytes.data(), size);
        return {};
    }

    InputFile file_;
    SensIndex index_;
    PngDecoder png_;
    std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace

RecordingResult OpenSensRecording(const std::string& path) {
    Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    Result<SensIndex> index = ReadSensIndex(file.value());
    if (!index.ok()) return index.status();
    return std::unique_ptr<Recording>(
        std::make_unique<SensRecording>(std::move(file.value()), std::move(index.value())));
}

}  // namespace tessera
