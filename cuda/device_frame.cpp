#include "cuda/device_frame.h"

#include <algorithm>

#include "cuda/device_pixels.h"

namespace tessera::TESSERA_DEVICE {

DeviceFrame::DeviceFrame(DeviceMemory& memory, Stream& stream)
    : stream_(stream),
      depth_m_(memory),
      intensity_(memory),
      tiles_(memory),
      gone_m_(memory),
      packed_colour_(memory),
      raw_depth_m_(memory),
      rough_(memory),
      reduced_(memory),
      extremes_(memory),
      colour_(memory),
      sum_tiles_(memory),
      sums_(memory) {}

bool DeviceFrame::Reserve(std::size_t pixels, bool colour) {
    identity_ = 0;  // buffers that grow lose their content
    return depth_m_.ReserveScratch(stream_, pixels) && tiles_.ReserveScratch(stream_, pixels) &&
           (!colour || (intensity_.ReserveScratch(stream_, pixels) &&
                        packed_colour_.ReserveScratch(stream_, pixels)));
}

bool DeviceFrame::Upload(const PreparedFrame& frame) {
    if (identity_ == frame.identity) return true;
    const std::size_t pixels = frame.depth_m.size();
    if (frame.depth_m.empty() || !Reserve(pixels, frame.has_colour)) return false;
    stream_.Upload(depth_m_.data(), frame.depth_m.data(), pixels * sizeof(float));
    if (frame.has_colour) {
        stream_.Upload(intensity_.data(), frame.intensity.data(), pixels * sizeof(float));
        stream_.Upload(packed_colour_.data(), frame.packed_colour.data(),
                       pixels * sizeof(std::uint32_t));
    }
    identity_ = frame.identity;
    return true;
}

const float* DeviceFrame::UploadGone(const PreparedFrame& frame) {
    const std::size_t pixels = frame.gone_m.size();
    if (pixels == 0 || !gone_m_.ReserveScratch(stream_, pixels)) return nullptr;
    stream_.Upload(gone_m_.data(), frame.gone_m.data(), pixels * sizeof(float));
    return gone_m_.data();
}

void DeviceFrame::Gate(const Frame& frame, const PreparedFrame::Config& config) {
    constexpr int kParts = GatedPixels::kParts;
    stream_.Upload(raw_depth_m_.data(), frame.depth_m.data(), frame.depth_m.size() * sizeof(float));
    float *nearest_m = extremes_.data(), *farthest_m = nearest_m + kParts;
    Fill(stream_, nearest_m, kParts, FrameCounts().nearest_m);
    Fill(stream_, farthest_m, kParts, FrameCounts().farthest_m);
    GatePixels(stream_,
               {raw_depth_m_.data(), frame.depth_m.width(), frame.depth_m.height(),
                static_cast<float>(config.disparity_offset_per_m),
                static_cast<float>(config.min_depth_m), static_cast<float>(config.max_depth_m)},
               {depth_m_.data(), nearest_m, farthest_m, sum_tiles_.data(), sums_.data()});
}

void DeviceFrame::SplitColour(const ColourImage& colour, int blur_px) {
    const auto pixels = static_cast<int>(colour.size());
    stream_.Upload(colour_.data(), colour.data(), colour.size() * sizeof(Rgb8));
    // The last pass must write to intensity_.
    float *to = intensity_.data(), *other = rough_.data();
    if (blur_px % 2 != 0) std::swap(to, other);
    MakeLuma(stream_, colour_.data(), pixels, to);
    for (int pass = 0; pass < blur_px; ++pass) {
        SmoothImage(stream_, to, colour.width(), colour.height(), other);
        std::swap(to, other);
    }
    PackColours(stream_, colour_.data(), intensity_.data(), pixels, packed_colour_.data());
}

void DeviceFrame::Reduce(PreparedFrame& p) {
    float* at = reduced_.data();
    for (std::size_t level = 0; level < p.reduced.size(); ++level) {
        auto& [intensity, depth_m] = p.reduced[level];
        const std::size_t pixels = depth_m.size();
        ReduceImages(stream_,
                     {depth_m_.data(), p.has_colour ? intensity_.data() : nullptr, p.width,
                      ReductionOf(p.width, p.height, level)},
                     depth_m.width(), depth_m.height(), at, at + pixels);
        stream_.Download(intensity.data(), at, pixels * sizeof(float));
        stream_.Download(depth_m.data(), at + pixels, pixels * sizeof(float));
        at += 2 * pixels;
    }
}

bool DeviceFrame::Prepare(const Frame& frame, const PreparedFrame::Config& config, bool bring,
                          PreparedFrame& p) {
    constexpr int kParts = GatedPixels::kParts;
    const std::size_t pixels = frame.depth_m.size();
    const bool colour = !frame.colour.empty();
    p.width = frame.depth_m.width();
    p.height = frame.depth_m.height();
    p.has_colour = colour;
    std::size_t reduced_pixels = 0;
    for (std::size_t level = 0; level < p.reduced.size(); ++level) {
        const int n = ReductionOf(p.width, p.height, level);
        for (auto* image : {&p.reduced[level].intensity, &p.reduced[level].depth_m}) {
            image->Resize(p.width / n, p.height / n);
            reduced_pixels += image->size();
        }
    }
    if (!Reserve(pixels, colour) || !raw_depth_m_.ReserveScratch(stream_, pixels) ||
        !reduced_.ReserveScratch(stream_, reduced_pixels) ||
        !extremes_.Reserve(stream_, 2 * kParts, 0) ||
        !sum_tiles_.ReserveScratch(stream_, GateRoom(static_cast<int>(pixels))) ||
        !sums_.Reserve(stream_, GatedPixels::kCounts, 0) ||
        (colour &&
         (!colour_.ReserveScratch(stream_, pixels) || !rough_.ReserveScratch(stream_, pixels))))
        return false;
    Gate(frame, config);
    if (colour) SplitColour(frame.colour, config.intensity_blur_px);

    double sums[GatedPixels::kCounts];
    float extremes[2 * kParts];
    stream_.Download(sums, sums_.data(), sizeof sums);
    stream_.Download(extremes, extremes_.data(), sizeof extremes);
    Reduce(p);
    Bring(bring, p);
    stream_.Wait();

    FrameCounts counts;
    counts.valid = static_cast<std::int64_t>(sums[GatedPixels::kValid]);
    counts.measured = static_cast<std::int64_t>(sums[GatedPixels::kMeasured]);
    counts.pairs = static_cast<std::int64_t>(sums[GatedPixels::kPairs]);
    counts.coherent = static_cast<std::int64_t>(sums[GatedPixels::kCoherent]);
    counts.nearest_m = *std::min_element(extremes, extremes + kParts);
    counts.farthest_m = *std::max_element(extremes + kParts, extremes + 2 * kParts);
    SetFacts(p.width, p.height, colour, counts, p);
    identity_ = p.identity;
    return true;
}

void DeviceFrame::Bring(bool bring, PreparedFrame& p) {
    const std::size_t pixels =
        static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height);
    const auto take = [&](auto& image, const auto& buffer, bool wanted) {
        image.Resize(wanted ? p.width : 0, wanted ? p.height : 0);
        if (wanted) stream_.Download(image.data(), buffer.data(), pixels * sizeof *image.data());
    };
    take(p.depth_m, depth_m_, bring);
    take(p.intensity, intensity_, bring && p.has_colour);
    take(p.packed_colour, packed_colour_, bring && p.has_colour);
}

}  // namespace tessera::TESSERA_DEVICE
