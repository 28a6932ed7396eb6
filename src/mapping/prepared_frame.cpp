#include "mapping/prepared_frame.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "mapping/frame_kernels.h"

namespace tessera {
namespace {

constexpr int kBand = 16;  // rows per task; fixed, so that sums have a fixed order

constexpr int kReducedWidths[] = {40, 80};  // 40 x 30 and 80 x 60 from 640 x 480

FrameCounts GateRows(const DepthImage& in, const MovingMask* moving, float offset, float low,
                     float high, int first, int last, DepthImage& out) {
    FrameCounts counts;
    std::vector<float> rest;
    for (int y = first; y < last; ++y) {
        const float* source = in.row(y);
        if (moving != nullptr) {
            rest.assign(source, source + in.width());
            HideMoving(*moving, y, in.width(), rest.data());
            source = rest.data();
        }
        float* target = out.row(y);
        for (int x = 0; x < in.width(); ++x) {
            const float z = CorrectedDepth(source[x], offset);
            const bool ok = InRange(z, low, high);
            target[x] = ok ? z : 0.0f;
            counts.valid += ok;
            counts.measured += z > 0.0f;
            counts.nearest_m = std::min(counts.nearest_m, ok ? z : 1e9f);
            counts.farthest_m = std::max(counts.farthest_m, target[x]);
        }
        for (int x = 0; x + 1 < in.width(); x += 2) {
            const bool both = target[x] > 0 && target[x + 1] > 0;
            counts.pairs += both;
            counts.coherent += both && Coherent(target[x], target[x + 1]);
        }
    }
    return counts;
}

void LumaRow(const Rgb8* in, float* out, int width) {
    for (int x = 0; x < width; ++x) out[x] = Luma255(in[x]) * (1.0f / 255.0f);
}

void Smooth(const Image<float>& in, int first, int last, Image<float>& out) {
    const int width = in.width();
    for (int y = first; y < last; ++y) {
        const RowsAround rows = RowsAround::Of(in.data(), width, in.height(), y);
        float* target = out.row(y);
        target[0] = SmoothAt(rows, 0, width);
        for (int x = 1; x + 1 < width; ++x) target[x] = SmoothInside(rows, x);
        target[width - 1] = SmoothAt(rows, width - 1, width);
    }
}

void PackRow(const Rgb8* colour, const float* luma, std::uint32_t* out, int width) {
    for (int x = 0; x < width; ++x) out[x] = PackColour(colour[x], luma[x]);
}

void ReduceDepth(const PreparedFrame& p, std::size_t level, DepthImage& out) {
    const int n = ReductionOf(p.width, p.height, level);
    out.Resize(p.width / n, p.height / n);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out(x, y) = p.depth_m(x * n + n / 2, y * n + n / 2);
}

void Reduce(const PreparedFrame& p, std::size_t level, PreparedFrame::Reduced& out) {
    const int n = ReductionOf(p.width, p.height, level), width = p.width / n, height = p.height / n;
    ReduceDepth(p, level, out.depth_m);
    out.intensity.Resize(width, height);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x)
            out.intensity(x, y) =
                p.has_colour ? MeanOfTile(p.intensity.data(), p.width, n, x, y) : -1.0f;
    });
}

template <class Work>
void ForBands(int height, const Work& work) {
    tbb::parallel_for(0, (height + kBand - 1) / kBand, [&](int band) {
        work(band, band * kBand, std::min(height, (band + 1) * kBand));
    });
}

// Fills `intensity` and `packed_colour`.
void SplitColour(const ColourImage& colour, int blur_px, PreparedFrame& p) {
    const int width = p.width, height = p.height;
    p.intensity.Resize(width, height);
    p.packed_colour.Resize(width, height);
    ForBands(height, [&](int, int first, int last) {
        for (int y = first; y < last; ++y) LumaRow(colour.row(y), p.intensity.row(y), width);
    });
    Image<float> smoothed;
    for (int pass = 0; pass < blur_px; ++pass) {
        smoothed.Resize(width, height);
        ForBands(height,
                 [&](int, int first, int last) { Smooth(p.intensity, first, last, smoothed); });
        std::swap(smoothed, p.intensity);
    }
    ForBands(height, [&](int, int first, int last) {
        for (int y = first; y < last; ++y)
            PackRow(colour.row(y), p.intensity.row(y), p.packed_colour.row(y), width);
    });
}

}  // namespace

void PreparedFrame::Config::Describe(ConfigParameters& p) {
    p.Add("min_depth_m", min_depth_m, {0.0, 100.0}, "m",
          "depth below this is ignored; normally the sensor's minimum range");
    p.Add(
        "max_depth_m", max_depth_m, {0.1, 100.0}, "m",
        "depth beyond this is ignored; structured-light noise grows with the square of the depth");
    p.Add("intensity_blur_px", intensity_blur_px, {0, 4}, "px",
          "number of times that the intensity is smoothed with a 1-2-1 kernel; a voxel is wider "
          "than a pixel, so unsmoothed intensity aliases");
    p.Add(
        "min_coherent_fraction", min_coherent_fraction, {0.0, 1.0}, "",
        "a frame counts as noise and is not used if a smaller fraction of its neighbouring depths "
        "agree within 5 %");
    p.Add("disparity_offset_per_m", disparity_offset_per_m, {-0.1, 0.1}, "1/m",
          "corrects depth z to z / (1 + offset z); calibration.refine estimates this error of "
          "triangulating sensors");
}

Status PreparedFrame::Config::Validate() const {
    if (min_depth_m >= max_depth_m)
        return Status::Error(
            fmt::format("frame.min_depth_m: {} m is not below frame.max_depth_m ({} m)",
                        min_depth_m, max_depth_m));
    return Status::Ok();
}

int ReductionOf(int width, int height, std::size_t level) {
    return std::max(1, std::min(width / kReducedWidths[level], height / 2));
}

void SetFacts(int width, int height, bool has_colour, const FrameCounts& counts, PreparedFrame& p) {
    static std::atomic<std::uint64_t> last_identity = 0;
    p.identity = ++last_identity;
    p.width = width;
    p.height = height;
    p.has_colour = has_colour;
    p.valid_depth_pixels = counts.valid;
    p.measured_pixels = counts.measured;
    p.coherent_fraction =
        counts.pairs > 0 ? static_cast<double>(counts.coherent) / static_cast<double>(counts.pairs)
                         : 0.0;
    p.nearest_m = counts.valid > 0 ? counts.nearest_m : 0.0f;
    p.farthest_m = counts.farthest_m;
    p.moving.reset();
    p.gone_m.Resize(0, 0);
}

namespace {

void PrepareDepth(const DepthImage& raw_m, bool has_colour, const PreparedFrame::Config& config,
                  const MovingMask* moving, PreparedFrame& p) {
    const int width = raw_m.width(), height = raw_m.height();
    p.depth_m.Resize(width, height);
    std::vector<FrameCounts> counts(static_cast<std::size_t>((height + kBand - 1) / kBand));
    ForBands(height, [&](int band, int first, int last) {
        counts[static_cast<std::size_t>(band)] =
            GateRows(raw_m, moving, static_cast<float>(config.disparity_offset_per_m),
                     static_cast<float>(config.min_depth_m), static_cast<float>(config.max_depth_m),
                     first, last, p.depth_m);
    });
    FrameCounts total;
    for (const FrameCounts& c : counts) {
        total.valid += c.valid;
        total.measured += c.measured;
        total.pairs += c.pairs;
        total.coherent += c.coherent;
        total.nearest_m = std::min(total.nearest_m, c.nearest_m);
        total.farthest_m = std::max(total.farthest_m, c.farthest_m);
    }
    SetFacts(raw_m.width(), raw_m.height(), has_colour, total, p);
}

}  // namespace

void RemaskDepth(const Frame& frame, const PreparedFrame::Config& config, PreparedFrame& p,
                 const MovingMask* moving) {
    PrepareDepth(frame.depth_m, p.has_colour, config, moving, p);
    for (std::size_t level = 0; level < p.reduced.size(); ++level)
        ReduceDepth(p, level, p.reduced[level].depth_m);
}

void ForgetColour(PreparedFrame& p) {
    p.has_colour = false;
    for (PreparedFrame::Reduced& reduced : p.reduced)
        std::fill_n(reduced.intensity.data(), reduced.intensity.size(), -1.0f);
}

Frame WithoutLeftOut(const Frame& frame, const PreparedFrame& prepared,
                     const PreparedFrame::Config& config) {
    Frame rest = prepared.moving ? WithoutMoving(*prepared.moving, frame) : frame;
    if (prepared.limit_m <= 0 || prepared.limit_m >= config.max_depth_m) return rest;
    const auto limit_m = static_cast<float>(prepared.limit_m),
               offset_per_m = static_cast<float>(config.disparity_offset_per_m);
    std::replace_if(
        rest.depth_m.data(), rest.depth_m.data() + rest.depth_m.size(),
        [&](float z_m) { return CorrectedDepth(z_m, offset_per_m) > limit_m; }, 0.0f);
    return rest;
}

void SetMoving(std::shared_ptr<const MovingMask> moving, PreparedFrame& p) {
    p.moving = std::move(moving);
    if (p.moving->gone_tiles == 0) return;
    p.gone_m.Resize(p.width, p.height);
    tbb::parallel_for(0, p.height, [&](int y) {
        const float* gone = p.moving->gone_m.row(p.moving->TileY(y));
        for (int x = 0; x < p.width; ++x) p.gone_m(x, y) = gone[p.moving->TileX(x)];
    });
}

void PrepareFrame(const Frame& frame, const PreparedFrame::Config& config, PreparedFrame& p,
                  const MovingMask* moving) {
    PrepareDepth(frame.depth_m, !frame.colour.empty(), config, moving, p);
    if (p.has_colour) {
        SplitColour(frame.colour, config.intensity_blur_px, p);
    } else {
        p.intensity = {};
        p.packed_colour = {};
    }
    for (std::size_t level = 0; level < p.reduced.size(); ++level)
        Reduce(p, level, p.reduced[level]);
}

}  // namespace tessera
