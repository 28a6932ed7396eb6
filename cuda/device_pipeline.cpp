#include "cuda/device_pipeline.h"

#include <fmt/format.h>

#include "core/check.h"
#include "cuda/device_integrator.h"
#include "cuda/device_mesher.h"
#include "cuda/device_sums.h"

namespace tessera::TESSERA_DEVICE {

DevicePipeline::DevicePipeline(std::string name, std::size_t limit_bytes)
    : name_(std::move(name)),
      memory_(limit_bytes),
      frame_(memory_, stream_),
      points_(memory_, stream_),
      residual_sums_(memory_, stream_),
      residuals_(memory_),
      sum_tiles_(memory_),
      sums_(memory_),
      views_(*this),
      icp_(*this) {}

void DevicePipeline::Prepare(const Frame& frame, const PreparedFrame::Config& config,
                             const MovingMask* moving, bool keep_images, PreparedFrame& prepared) {
    const Frame masked = moving != nullptr ? WithoutMoving(*moving, frame) : Frame();
    const Frame& seen = moving != nullptr ? masked : frame;
    if (!frame_.Prepare(seen, config, keep_images, prepared)) PrepareFrame(seen, config, prepared);
}

std::unique_ptr<Integrator> DevicePipeline::MakeIntegrator(const Integrator::Config& config,
                                                           const PinholeCamera& camera) {
    return std::make_unique<DeviceIntegrator>(*this, config, camera);
}

std::unique_ptr<BlockMesher> DevicePipeline::MakeBlockMesher() {
    return std::make_unique<DeviceMesher>(*this);
}

DeviceMap* DevicePipeline::MirrorOf(const BlockMap& map) {
    if (map_ && mirrored_ == map.identity()) return map_.get();
    TESSERA_CHECK(map.count() == map.size() - 1,
                  "a map without releases is needed; it has {} blocks and {} ids", map.count(),
                  map.size());
    mirrored_ = 0;
    map_ = std::make_unique<DeviceMap>(map.config().voxel_size_m, map.config().band(), memory_,
                                       stream_);
    if (!map_->Load(map.size(), map.view().coords, map.field(0), map.weight(0), map.colour(0)))
        map_.reset();
    if (map_) mirrored_ = map.identity();
    return map_.get();
}

bool DevicePipeline::ReserveSums(int points) {
    const auto count = static_cast<std::size_t>(points);
    return sums_.Reserve(stream_, SumLayout::kCount, 0) &&
           sum_tiles_.ReserveScratch(stream_, TilesOfPoints(points)) &&
           residuals_.ReserveScratch(stream_, kPointResiduals * count);
}

void DevicePipeline::SetPoints(const BlockMap& map, const PreparedFrame& frame,
                               const PointArguments& arguments, FramePoints& slots) {
    has_distance_residual_ = has_intensity_residual_ = false;
    points_.Clear();
    // Without room there are no points, and the frame is lost.
    const bool room = MirrorOf(map) != nullptr && ReserveSums(arguments.width * arguments.height);
    slots.Allocate(arguments, room ? MakePoints(frame, arguments, points_) : 0);
}

std::int64_t DevicePipeline::MakePoints(const PreparedFrame& frame, const PointArguments& arguments,
                                        DevicePoints& points) {
    if (!frame_.Upload(frame) || !residual_sums_.Reserve(arguments.width, arguments.height))
        return 0;
    PointArguments a = arguments;
    a.depth.pixels = frame_.depth_m();
    if (a.intensity.width > 0) a.intensity.pixels = frame_.intensity();
    if (a.chroma) a.packed_colour = frame_.packed_colour();
    return points.Build(a);
}

PoseSums DevicePipeline::Sum(const SdfArguments& arguments, int) {
    PoseSums sums;
    if (points_.count() == 0) return sums;
    SdfArguments a = arguments;
    static_cast<BlockMapView&>(a) = map_->view().readable();
    a.x = points_.x();
    a.y = points_.y();
    a.z = points_.z();
    a.intensity = points_.intensity();
    a.weight = points_.weight();
    if (a.colour != nullptr) {
        a.cb = points_.cb();
        a.cr = points_.cr();
        a.colour = map_->view().colour;
    }
    has_distance_residual_ = a.distance_residual != nullptr;
    has_intensity_residual_ = a.intensity_residual != nullptr;
    float* const residuals = residuals_.data();
    if (has_distance_residual_) {
        a.distance_residual = residuals;
        for (int k = 0; k < 3; ++k) a.gradient[k] = residuals + (2 + k) * points_.count();
    }
    if (has_intensity_residual_) a.intensity_residual = residuals + points_.count();
    SumSdfPoints(stream_, a, points_.count(), sum_tiles_.data(), sums_.data());
    stream_.Download(sums.value, sums_.data(), sizeof sums.value);
    stream_.Wait();
    return sums;
}

ResidualSums DevicePipeline::SumResiduals(const ResidualArguments& arguments) {
    return SumResidualsOf(arguments, points_, residuals_.data());
}

ResidualSums DevicePipeline::SumResidualsOf(ResidualArguments a, const DevicePoints& points,
                                            const float* residuals) {
    ResidualSums sums;
    if (points.count() == 0) return sums;
    a.x = points.x();
    a.y = points.y();
    a.z = points.z();
    a.intensity = points.intensity();
    a.weight = points.weight();
    a.distance_residual = residuals;
    a.intensity_residual = residuals + points.count();
    for (int k = 0; k < 3; ++k) a.gradient[k] = residuals + (2 + k) * points.count();
    a.image = frame_.intensity();
    // The kinds share the same buffers, because the stream runs them in order.
    residual_sums_.Sum<DistanceSums>(a, sums.distances);
    if (a.has_intensity) residual_sums_.Sum<ScoreSums>(a, sums.scores);
    if (a.wants_shutter) residual_sums_.Sum<ShutterSums>(a, sums.shutter);
    stream_.Wait();
    return sums;
}

void DevicePipeline::RemoveShading(const ShadingArguments& arguments) {
    RemoveShadingOf(arguments, points_, residuals_.data());
}

void DevicePipeline::RemoveShadingOf(ShadingArguments a, DevicePoints& points,
                                     const float* residuals) {
    if (points.count() == 0) return;
    a.residual = residuals + points.count();
    a.intensity = points.intensity();
    residual_sums_.RemoveShading(a);
}

void DevicePipeline::Download(const DevicePoints& from, FramePoints& points) {
    const auto bytes = static_cast<std::size_t>(from.count()) * sizeof(float);
    stream_.Download(points.x.data(), from.x(), bytes);
    stream_.Download(points.y.data(), from.y(), bytes);
    stream_.Download(points.z.data(), from.z(), bytes);
    stream_.Download(points.intensity.data(), from.intensity(), bytes);
    stream_.Download(points.weight.data(), from.weight(), bytes);
    if (!points.cb.empty()) {
        stream_.Download(points.cb.data(), from.cb(), bytes);
        stream_.Download(points.cr.data(), from.cr(), bytes);
    }
    stream_.Wait();
}

void DevicePipeline::TakeResiduals(std::vector<float>& distance, std::vector<float>& intensity) {
    const std::size_t bytes = static_cast<std::size_t>(points_.count()) * sizeof(float);
    if (has_distance_residual_) stream_.Download(distance.data(), residuals_.data(), bytes);
    if (has_intensity_residual_)
        stream_.Download(intensity.data(), residuals_.data() + points_.count(), bytes);
    stream_.Wait();
}

}  // namespace tessera::TESSERA_DEVICE
