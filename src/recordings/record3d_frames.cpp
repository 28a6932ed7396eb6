#include "recordings/record3d_frames.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "recordings/recorded_stamps.h"

namespace tessera {

Record3dFrames FindRecord3dFrames(const ZipFile& archive) {
    constexpr std::string_view kFolder = "rgbd/";
    Record3dFrames frames;
    for (std::size_t i = 0; i < archive.count(); ++i) {
        std::string_view name = archive.Name(i);
        if (!name.starts_with(kFolder)) continue;
        name.remove_prefix(kFolder.size());
        std::uint32_t number = 0;
        const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
        if (error != std::errc()) continue;
        name.remove_prefix(static_cast<std::size_t>(end - name.data()));
        if (name == ".jpg") frames[number].image = i;
        if (name == ".depth") frames[number].depth = i;
        if (name == ".conf") frames[number].confidence = i;
    }
    std::erase_if(frames, [](const auto& f) { return !f.second.image && !f.second.depth; });
    return frames;
}

std::vector<RecordedPair> StampedRecord3dPairs(const Record3dFrames& frames,
                                               std::span<const double> stamps_s) {
    const bool one_each = stamps_s.size() == frames.size();
    if (frames.empty()) return {};
    if (!one_each && stamps_s.size() != std::size_t{frames.rbegin()->first} + 1) return {};
    std::vector<RecordedPair> pairs;
    std::size_t place = 0;
    for (const auto& [number, frame] : frames) {
        const double stamp_s = stamps_s[one_each ? place : number];
        if (frame.whole()) pairs.push_back({stamp_s, stamp_s});
        ++place;
    }
    if (!DepthStampsIncrease(pairs)) pairs.clear();
    return pairs;
}

std::vector<RecordedPair> EvenRecord3dPairs(const Record3dFrames& frames, double fps) {
    std::vector<RecordedPair> pairs;
    for (const auto& [number, frame] : frames) {
        const double stamp_s = (number - frames.begin()->first) / fps;
        if (frame.whole()) pairs.push_back({stamp_s, stamp_s});
    }
    return pairs;
}

ImageSize Record3dDepthSize(ImageSize said, ImageSize colour, std::uint64_t bytes) {
    constexpr std::int64_t kMostSide_px = 8192;
    constexpr std::uint64_t kMostBytes = sizeof(float) * kMostSide_px * kMostSide_px;
    if (bytes == 0 || bytes % sizeof(float) != 0 || bytes > kMostBytes) return {};
    const auto pixels = static_cast<std::int64_t>(bytes / sizeof(float));
    if (std::int64_t{said.width} * said.height == pixels) return said;
    const double shape = static_cast<double>(colour.width) / colour.height;
    const std::int64_t width = std::lround(std::sqrt(static_cast<double>(pixels) * shape));
    if (width < 1 || pixels % width != 0) return {};
    const std::int64_t height = pixels / width;
    if (width > kMostSide_px || height > kMostSide_px) return {};
    if (std::abs(static_cast<double>(width) - static_cast<double>(height) * shape) > 0.5) return {};
    return {static_cast<int>(width), static_cast<int>(height)};
}

}  // namespace tessera
