#include "synth/frame_faults.h"

#include <algorithm>
#include <cmath>

#include "synth/hash_random.h"

namespace tessera {
namespace {

constexpr std::uint64_t kFaultStream = 7;
constexpr std::int64_t kGoodAtFirst = 30;  // frames
constexpr float kDepthUnitsPerMetre = 1000, kFarthest_m = 65.535f;

void FlipBits(std::uint64_t random, Frame& frame) {
    const auto flipped = [&](std::size_t number, int bits) {
        const std::uint64_t key = MixBits(random + number);
        return key % 1000 < static_cast<std::uint64_t>(bits)
                   ? std::uint32_t{1} << (key / 1000 % static_cast<std::uint64_t>(bits))
                   : 0u;
    };
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
        float& z_m = frame.depth_m.data()[i];
        const auto raw = static_cast<std::uint32_t>(
            std::lround(std::clamp(z_m, 0.0f, kFarthest_m) * kDepthUnitsPerMetre));
        z_m = static_cast<float>(raw ^ flipped(i, 16)) / kDepthUnitsPerMetre;
    }
    for (std::size_t i = 0; i < frame.colour.size(); ++i) {
        Rgb8& c = frame.colour.data()[i];
        c.g = static_cast<std::uint8_t>(c.g ^ flipped(i + frame.depth_m.size(), 8));
    }
}

// The middle third of the rows shows what is a quarter of the image away.
template <class Pixel>
void MoveBlock(Image<Pixel>& image) {
    const Image<Pixel> from = image;
    for (int y = image.height() / 3; y < 2 * image.height() / 3; ++y)
        for (int x = 0; x < image.width(); ++x)
            image(x, y) = from((x + image.width() / 4) % image.width(),
                               (y + image.height() / 4) % image.height());
}

template <class Pixel>
void ClearStripes(Image<Pixel>& image) {
    for (int y = 0; y < image.height(); ++y)
        if (y / 8 % 2 == 1) std::fill_n(image.row(y), image.width(), Pixel{});
}

template <class Pixel>
void Zoom(const PinholeCamera& camera, Image<Pixel>& image) {
    constexpr double kZoom = 1.5;
    const Image<Pixel> from = image;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            image(x, y) = from(static_cast<int>(camera.cx + (x - camera.cx) / kZoom),
                               static_cast<int>(camera.cy + (y - camera.cy) / kZoom));
}

void Swap(Frame& frame) {
    if (frame.colour.empty()) return;
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
        float& z_m = frame.depth_m.data()[i];
        Rgb8& c = frame.colour.data()[i];
        const auto grey = static_cast<std::uint8_t>(std::clamp(50 * z_m, 0.0f, 255.0f));
        z_m = 0.02f * static_cast<float>(c.g);
        c = {grey, grey, grey};
    }
}

void Scale(float factor, DepthImage& depth_m) {
    for (std::size_t i = 0; i < depth_m.size(); ++i) depth_m.data()[i] *= factor;
}

void Fill(float z_m, Rgb8 colour, Frame& frame) {
    std::fill_n(frame.depth_m.data(), frame.depth_m.size(), z_m);
    std::fill_n(frame.colour.data(), frame.colour.size(), colour);
}

}  // namespace

void FrameFaults::Config::Describe(ConfigParameters& p) {
    p.Add("share", share, {0, 0.9}, "",
          "share of the frames that get a fault: wrong bits, moved blocks, a wrong scale, stripes, "
          "saturated or black images, repeated or late frames, swapped images, another camera");
    p.Add("in_a_row", in_a_row, {1, 1000}, "frames", "frames in a row that get the same fault");
}

FrameFaults::FrameFaults(const Config& config, const PinholeCamera& camera, std::uint64_t seed)
    : config_(config), camera_(camera), seed_(seed) {}

std::optional<FrameFault> FrameFaults::Of(std::int64_t frame) const {
    if (frame < kGoodAtFirst) return std::nullopt;
    const auto group = static_cast<std::uint64_t>((frame - kGoodAtFirst) / config_.in_a_row);
    const std::uint64_t key = StreamKey(seed_, kFaultStream, group);
    if (UniformFromBits(MixBits(key)) >= config_.share) return std::nullopt;
    return static_cast<FrameFault>(MixBits(key + 1) % kFrameFaults);
}

void FrameFaults::Apply(Frame& frame) {
    if (config_.share <= 0) return;
    const std::optional<FrameFault> fault = Of(frame.index);
    if (!fault) {
        last_colour_ = frame.colour;
        last_depth_m_ = frame.depth_m;
    } else if (*fault == FrameFault::kRepeated) {
        if (last_depth_m_.empty()) return;  // the first that was read: nothing to repeat
        frame.colour = last_colour_;
        frame.depth_m = last_depth_m_;
    } else {
        const auto number = static_cast<std::uint64_t>(frame.index);
        ApplyFault(*fault, camera_, StreamKey(seed_, kFaultStream + 1, number), frame);
    }
}

void ApplyFault(FrameFault fault, const PinholeCamera& camera, std::uint64_t random, Frame& frame) {
    constexpr float kSensorEnd_m = 10;
    constexpr double kLate_s = 0.5;
    switch (fault) {
        case FrameFault::kBits: return FlipBits(random, frame);
        case FrameFault::kBlocks: MoveBlock(frame.depth_m); return MoveBlock(frame.colour);
        case FrameFault::kNear: return Scale(0.1f, frame.depth_m);
        case FrameFault::kFar: return Scale(10, frame.depth_m);
        case FrameFault::kStripes: ClearStripes(frame.depth_m); return ClearStripes(frame.colour);
        case FrameFault::kSaturated: return Fill(kSensorEnd_m, {255, 255, 255}, frame);
        case FrameFault::kBlack: return Fill(0, {0, 0, 0}, frame);
        case FrameFault::kRepeated: return;
        case FrameFault::kOutOfOrder:
            frame.stamp_s -= kLate_s;
            frame.colour_stamp_s -= kLate_s;
            return;
        case FrameFault::kSwapped: return Swap(frame);
        case FrameFault::kZoomed: Zoom(camera, frame.depth_m); return Zoom(camera, frame.colour);
    }
}

}  // namespace tessera
