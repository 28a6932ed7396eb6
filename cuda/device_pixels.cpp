#include "cuda/device_pixels.h"

#include "cuda/device_loops.h"
#include "mapping/frame_kernels.h"

namespace tessera::TESSERA_DEVICE {

namespace pixel_bodies {

// Per pixel.
struct GatePixel {
    DepthGate gate;
    GatedPixels gated;

    // 0 where missing or out of range.
    TESSERA_HD_MEMBER float Gated(float z) const {
        return InRange(z, gate.low_m, gate.high_m) ? z : 0.0f;
    }

    TESSERA_HD_MEMBER void operator()(int i, float* counts) const {
        const float z = CorrectedDepth(gate.raw_m[i], gate.offset_per_m), here = Gated(z);
        gated.depth_m[i] = here;
        if (z > 0) counts[GatedPixels::kMeasured] += 1.0f;
        if (!InRange(z, gate.low_m, gate.high_m)) return;
        counts[GatedPixels::kValid] += 1.0f;
        AtomicMin(gated.nearest_m + i % GatedPixels::kParts, here);
        AtomicMax(gated.farthest_m + i % GatedPixels::kParts, here);
        const int x = i % gate.width;
        if (x % 2 != 0 || x + 1 >= gate.width || !(here > 0)) return;
        const float right = Gated(CorrectedDepth(gate.raw_m[i + 1], gate.offset_per_m));
        if (!(right > 0)) return;
        counts[GatedPixels::kPairs] += 1.0f;
        if (Coherent(here, right)) counts[GatedPixels::kCoherent] += 1.0f;
    }
};

struct Set {
    float* values;
    float value;
    TESSERA_HD_MEMBER void operator()(int i) const { values[i] = value; }
};

// Per pixel.
struct LumaOfPixel {
    const Rgb8* colour;
    float* luma;
    TESSERA_HD_MEMBER void operator()(int i) const {
        luma[i] = Luma255(colour[i]) * (1.0f / 255.0f);
    }
};

// Per pixel.
struct SmoothPixel {
    const float* in;
    int width, height;
    float* out;
    TESSERA_HD_MEMBER void operator()(int i) const {
        out[i] = SmoothAt(RowsAround::Of(in, width, height, i / width), i % width, width);
    }
};

// Per pixel.
struct PackPixel {
    const Rgb8* colour;
    const float* luma;
    std::uint32_t* packed;
    TESSERA_HD_MEMBER void operator()(int i) const { packed[i] = PackColour(colour[i], luma[i]); }
};

// Per pixel of the reduced image.
struct ReducePixel {
    Reduction of;
    int reduced_width;
    float *intensity, *depth_m;
    TESSERA_HD_MEMBER void operator()(int i) const {
        const int x = i % reduced_width, y = i / reduced_width;
        depth_m[i] = of.depth_m[(y * of.n + of.n / 2) * of.width + x * of.n + of.n / 2];
        intensity[i] =
            of.intensity != nullptr ? MeanOfTile(of.intensity, of.width, of.n, x, y) : -1.0f;
    }
};

}  // namespace pixel_bodies

void Fill(Stream& stream, float* values, int count, float value) {
    ForEach(stream, count, pixel_bodies::Set{values, value});
}

void GatePixels(Stream& stream, const DepthGate& gate, const GatedPixels& gated) {
    SumTiles<GatedPixels::kCounts>(stream, gate.width * gate.height,
                                   pixel_bodies::GatePixel{gate, gated}, gated.sum_tiles,
                                   gated.counts);
}

void MakeLuma(Stream& stream, const Rgb8* colour, int count, float* luma) {
    ForEach(stream, count, pixel_bodies::LumaOfPixel{colour, luma});
}

void SmoothImage(Stream& stream, const float* in, int width, int height, float* out) {
    ForEach(stream, width * height, pixel_bodies::SmoothPixel{in, width, height, out});
}

void PackColours(Stream& stream, const Rgb8* colour, const float* luma, int count,
                 std::uint32_t* packed) {
    ForEach(stream, count, pixel_bodies::PackPixel{colour, luma, packed});
}

void ReduceImages(Stream& stream, const Reduction& of, int reduced_width, int reduced_height,
                  float* intensity, float* depth_m) {
    ForEach(stream, reduced_width * reduced_height,
            pixel_bodies::ReducePixel{of, reduced_width, intensity, depth_m});
}

std::size_t GateRoom(int pixels) { return TileRoom(pixels, GatedPixels::kCounts); }

}  // namespace tessera::TESSERA_DEVICE
