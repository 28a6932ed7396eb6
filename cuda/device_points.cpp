#include "cuda/device_points.h"

#include "cuda/device_loops.h"

namespace tessera::TESSERA_DEVICE {

namespace point_bodies {

// Per slot; counts those with a point.
struct MakePoint {
    PointArguments arguments;
    float *x, *y, *z, *intensity, *weight;

    TESSERA_HD_MEMBER void operator()(int i, float* sums) const {
        const PointArguments& a = arguments;
        const PointRow row = RowOfPoints(a, i / a.width);
        const int u = i % a.width * a.step + a.step / 2;
        const float d = u < a.depth.width ? a.depth.At(u, row.v) : 0.0f;
        const bool valid = d > 0;
        const CameraPoint p = valid ? PointOfPixel(a, row, u, d) : CameraPoint{0, 0, 0};
        x[i] = p.x;
        y[i] = p.y;
        z[i] = p.z;
        weight[i] = valid ? PointWeight(d, a.depth_exponent) : 0.0f;
        intensity[i] = valid && a.intensity.pixels != nullptr ? IntensityOfPoint(a, row, u, p) : -1.0f;
        if (valid) sums[0] += 1.0f;
    }
};

}  // namespace point_bodies

DevicePoints::DevicePoints(DeviceMemory& memory, Stream& stream)
    : stream_(stream), x_(memory), y_(memory), z_(memory), intensity_(memory), weight_(memory), tiles_(memory), valid_(memory) {}

bool DevicePoints::Reserve(std::size_t points) {
    bool room = valid_.Reserve(stream_, 1, 0) && tiles_.ReserveScratch(stream_, TileCount(static_cast<int>(points)));
    for (auto* buffer : {&x_, &y_, &z_, &intensity_, &weight_}) room = room && buffer->ReserveScratch(stream_, points);
    return room;
}

bool DevicePoints::Build(const PointArguments& a, std::int64_t& valid) {
    count_ = 0;
    valid = 0;
    const int count = a.width * a.height;
    if (!Reserve(static_cast<std::size_t>(count))) return false;
    SumTiles<1>(stream_, count,
                point_bodies::MakePoint{a, x_.data(), y_.data(), z_.data(), intensity_.data(), weight_.data()}, tiles_.data(),
                valid_.data());
    double counted = 0;
    stream_.Download(&counted, valid_.data(), sizeof counted);
    stream_.Wait();
    valid = static_cast<std::int64_t>(counted);
    count_ = count;
    return true;
}

}  // namespace tessera::TESSERA_DEVICE
