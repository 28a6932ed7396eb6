#include "cuda/device_points.h"

#include "cuda/device_loops.h"

namespace tessera::TESSERA_DEVICE {

namespace point_bodies {

// Per slot; counts those with a point.
struct MakePoint {
    PointArguments arguments;
    float *x, *y, *z, *intensity, *weight, *normal_x, *normal_y, *normal_z, *cb, *cr;

    TESSERA_HD_MEMBER void operator()(int i, float* sums) const {
        const PointArguments& a = arguments;
        const PointRow row = RowOfPoints(a, i / a.width);
        const int u = i % a.width * a.step + a.step / 2;
        const float d = u < a.depth.width ? a.depth.At(u, row.v) : 0.0f;
        const CameraPoint p = d > 0 ? PointOfPixel(a, row, u, d) : CameraPoint{0, 0, 0};
        x[i] = p.x;
        y[i] = p.y;
        z[i] = p.z;
        bool valid = d > 0;
        if (a.normal_radius_px >= 0) {
            CameraPoint n{0, 0, 0};
            valid = valid && NormalAt(a.depth, u, row.v, a.normal_radius_px, n);
            normal_x[i] = n.x;
            normal_y[i] = n.y;
            normal_z[i] = n.z;
        }
        weight[i] = valid ? PointWeight(d, a.noise_depth_m, a.nearest_m) : 0.0f;
        intensity[i] =
            valid && a.intensity.pixels != nullptr ? IntensityOfPoint(a, row, u, p) : -1.0f;
        if (a.chroma) {
            const Chroma c = intensity[i] >= 0 ? ChromaOfPoint(a, row, u, p) : Chroma{0, 0};
            cb[i] = c.cb;
            cr[i] = c.cr;
        }
        if (valid) sums[0] += 1.0f;
    }
};

}  // namespace point_bodies

DevicePoints::DevicePoints(DeviceMemory& memory, Stream& stream)
    : stream_(stream),
      x_(memory),
      y_(memory),
      z_(memory),
      intensity_(memory),
      weight_(memory),
      normals_(memory),
      chroma_(memory),
      tiles_(memory),
      valid_(memory) {}

bool DevicePoints::Reserve(std::size_t points, bool normals, bool chroma) {
    bool room = valid_.Reserve(stream_, 1, 0) &&
                tiles_.ReserveScratch(stream_, TileRoom(static_cast<int>(points), 1));
    for (auto* buffer : {&x_, &y_, &z_, &intensity_, &weight_})
        room = room && buffer->ReserveScratch(stream_, points);
    return room && (!normals || normals_.ReserveScratch(stream_, 3 * points)) &&
           (!chroma || chroma_.ReserveScratch(stream_, 2 * points));
}

std::int64_t DevicePoints::Build(const PointArguments& a) {
    const int count = a.width * a.height;
    const bool normals = a.normal_radius_px >= 0;
    count_ = 0;
    if (!Reserve(static_cast<std::size_t>(count), normals, a.chroma)) return 0;
    count_ = count;
    float* const n = normals_.data();
    float* const c = chroma_.data();
    SumTiles<1>(stream_, count,
                point_bodies::MakePoint{a, x_.data(), y_.data(), z_.data(), intensity_.data(),
                                        weight_.data(), n, normals ? n + count : nullptr,
                                        normals ? n + 2 * count : nullptr, c,
                                        a.chroma ? c + count : nullptr},
                tiles_.data(), valid_.data());
    double valid = 0;
    stream_.Download(&valid, valid_.data(), sizeof valid);
    stream_.Wait();
    return static_cast<std::int64_t>(valid);
}

}  // namespace tessera::TESSERA_DEVICE
