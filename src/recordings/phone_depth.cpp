#include "recordings/phone_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <tuple>

namespace tessera {
namespace {

template <class Pixel, class ValueOf>
Status RemoveBelow(const Image<Pixel>& confidence, int least, Image<std::uint16_t>& depth,
                   ValueOf value_of) {
    if (confidence.width() != depth.width() || confidence.height() != depth.height())
        return Status::Error(fmt::format("confidence has {} x {} pixels, but depth has {} x {}",
                                         confidence.width(), confidence.height(), depth.width(),
                                         depth.height()));
    for (std::size_t i = 0; i < depth.size(); ++i)
        if (value_of(confidence.data()[i]) < least) depth.data()[i] = 0;
    return {};
}

}  // namespace

PinholeCamera ScaledTo(const PinholeCamera& camera, int width, int height) {
    const double sx = static_cast<double>(width) / camera.width;
    const double sy = static_cast<double>(height) / camera.height;
    return {.width = width,
            .height = height,
            .fx = camera.fx * sx,
            .fy = camera.fy * sy,
            .cx = (camera.cx + 0.5) * sx - 0.5,
            .cy = (camera.cy + 0.5) * sy - 0.5};
}

Status SetPhoneCameras(const PinholeCamera& colour, ImageSize depth, RecordingInfo& info) {
    const double sx = static_cast<double>(depth.width) / colour.width;
    const double sy = static_cast<double>(depth.height) / colour.height;
    constexpr double kRounding = 0.02;  // a side may have been rounded to whole blocks of pixels
    if (!(std::abs(sx / sy - 1) < kRounding))
        return Status::Error(fmt::format(
            "colour has {} x {} pixels, but depth has {} x {}, another shape; give the images as "
            "the app stored them, not turned or cropped",
            colour.width, colour.height, depth.width, depth.height));
    info.colour_camera.pinhole = colour;
    info.depth_camera.pinhole = ScaledTo(colour, depth.width, depth.height);
    constexpr double kMillimetres = 1000;
    info.depth_camera.depth_scale = info.colour_camera.depth_scale = kMillimetres;
    return {};
}

Status RemoveUnsure(const Image<std::uint8_t>& confidence, int least, Image<std::uint16_t>& depth) {
    return RemoveBelow(confidence, least, depth, [](std::uint8_t value) { return value; });
}

Status RemoveUnsure(const ColourImage& confidence, int least, Image<std::uint16_t>& depth) {
    return RemoveBelow(confidence, least, depth, [](Rgb8 value) { return value.r; });
}

std::vector<NumberedFile> NumberedFiles(const std::string& folder, std::string_view extension) {
    namespace fs = std::filesystem;
    std::vector<NumberedFile> files;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        NumberedFile file{.number = 0, .name = entry->path().filename().string()};
        const char *first = file.name.data(), *last = first + file.name.size();
        const auto [at, error] = std::from_chars(first, last, file.number);
        if (error != std::errc() || at == last || *at != '.') continue;
        if (std::string_view(at + 1, last) == extension) files.push_back(std::move(file));
    }
    std::ranges::sort(files, {}, [](const NumberedFile& f) { return std::tie(f.number, f.name); });
    const auto doubled = std::unique(
        files.begin(), files.end(),
        [](const NumberedFile& a, const NumberedFile& b) { return a.number == b.number; });
    files.erase(doubled, files.end());
    return files;
}

std::string NameOfNumber(const std::string& subfolder, const std::vector<NumberedFile>& files,
                         std::uint64_t number) {
    const auto found = std::ranges::lower_bound(files, number, {}, &NumberedFile::number);
    if (found == files.end() || found->number != number) return {};
    return subfolder + "/" + found->name;
}

std::vector<PhoneDepth> FindPhoneDepth(const std::string& folder, const std::string& depth,
                                       const std::string& confidence, RecordingInfo& info) {
    const std::vector<NumberedFile> sure = NumberedFiles(folder + "/" + confidence, "png");
    std::vector<PhoneDepth> found;
    std::size_t without = 0;
    for (const NumberedFile& file : NumberedFiles(folder + "/" + depth, "png")) {
        found.push_back(
            {file.number, depth + "/" + file.name, NameOfNumber(confidence, sure, file.number)});
        without += found.back().confidence.empty() ? 1 : 0;
    }
    if (without < found.size())
        info.notes.push_back("low-confidence depth (the lowest of three levels) is ignored");
    if (without > 0)
        info.warnings.push_back(fmt::format(
            "{} of {} depth images have no confidence image; all of their depth is used", without,
            found.size()));
    return found;
}

Result<ImageSize> PhoneImages::FirstSize(const std::vector<std::string>& names) {
    Status error = Status::Error("no image");
    for (std::size_t i = 0; i < names.size(); ++i) {
        Result<ImageSize> size = decoder_.Load(PathOf(names[i]));
        if (size.ok()) return size;
        if (i == 0) error = WithoutFolder(size.status());
    }
    return error;
}

Status PhoneImages::ReadColour(const std::string& name, ColourImage& image) {
    return WithoutFolder(decoder_.ReadColour(PathOf(name), image));
}

Status PhoneImages::ReadDepth(const PhoneDepth& names, Image<std::uint16_t>& depth) {
    constexpr int kLeast = 1;
    Status status = decoder_.ReadDepth(PathOf(names.depth), depth);
    if (!status.ok() || names.confidence.empty()) return WithoutFolder(status);
    status = decoder_.ReadColour(PathOf(names.confidence), confidence_);
    if (!status.ok()) return WithoutFolder(status);
    status = RemoveUnsure(confidence_, kLeast, depth);
    return status.ok() ? status : Status::Error(names.confidence + ": " + status.message());
}

Status PhoneImages::WithoutFolder(const Status& status) const {
    const std::string prefix = PathOf("");
    if (status.ok() || !status.message().starts_with(prefix)) return status;
    return Status::Error(status.message().substr(prefix.size()));
}

}  // namespace tessera
