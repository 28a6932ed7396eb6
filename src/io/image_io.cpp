#include "io/image_io.h"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "io/file.h"
#include "io/image_decoder.h"
#include "io/jpeg_encoder.h"

namespace tessera {
namespace {

// cv::Mat has no const view of external pixels. The wrapped pixels are only read.
template <class T>
cv::Mat Wrap(const Image<T>& image, int type) {
    return {image.height(), image.width(), type, const_cast<T*>(image.data())};
}

Status WritePixels(const std::string& path, const cv::Mat& pixels) {
    if (pixels.empty()) return Status::Error(path + ": there are no pixels to write");
    std::vector<std::uint8_t> bytes;
    try {
        const std::string ending = std::filesystem::path(path).extension().string();
        cv::imencode(ending, pixels, bytes, {cv::IMWRITE_JPEG_QUALITY, kFineJpegQuality});
    } catch (const cv::Exception&) {  // the extension is unknown
        bytes.clear();
    }
    if (bytes.empty()) return Status::Error(path + ": is not a supported image format; use .png");
    AtomicFile file(path);
    file.Write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return file.Commit(AtomicFile::Sync::kLater);
}

}  // namespace

Result<ColourImage> ReadColourImage(const std::string& path) {
    ColourImage image;
    if (Status status = ImageDecoder().ReadColour(path, image); !status.ok()) return status;
    return image;
}

Result<Image<std::uint16_t>> ReadDepthImage(const std::string& path) {
    Image<std::uint16_t> image;
    if (Status status = ImageDecoder().ReadDepth(path, image); !status.ok()) return status;
    return image;
}

void StoreDepth(const DepthImage& depth_m, double units_per_m, Image<std::uint16_t>& stored) {
    stored.Resize(depth_m.width(), depth_m.height());
    const float* from = depth_m.data();
    std::uint16_t* to = stored.data();
    for (std::size_t i = 0; i < stored.size(); ++i) {
        const double value = static_cast<double>(from[i]) * units_per_m + 0.5;
        to[i] =
            static_cast<std::uint16_t>(value >= 0.5 && value < 65536 ? static_cast<int>(value) : 0);
    }
}

Status WriteColourImage(const std::string& path, const ColourImage& image) {
    cv::Mat bgr;
    if (!image.empty()) cv::cvtColor(Wrap(image, CV_8UC3), bgr, cv::COLOR_RGB2BGR);
    return WritePixels(path, bgr);
}

Status WriteDepthImage(const std::string& path, const Image<std::uint16_t>& image) {
    return WritePixels(path, Wrap(image, CV_16UC1));
}

Status WriteGreyImage(const std::string& path, const Image<std::uint8_t>& image) {
    return WritePixels(path, Wrap(image, CV_8UC1));
}

}  // namespace tessera
