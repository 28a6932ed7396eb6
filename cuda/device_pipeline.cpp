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
      depth_m_(memory_),
      packed_colour_(memory_),
      tiles_(memory_),
      x_(memory_),
      y_(memory_),
      z_(memory_),
      intensity_(memory_),
      weight_(memory_),
      distance_residual_(memory_),
      intensity_residual_(memory_),
      sum_tiles_(memory_),
      sums_(memory_) {}

std::unique_ptr<Integrator> DevicePipeline::MakeIntegrator(const Integrator::Config& config, const PinholeCamera& camera) {
    return std::make_unique<DeviceIntegrator>(*this, config, camera);
}

std::unique_ptr<BlockMesher> DevicePipeline::MakeBlockMesher() { return std::make_unique<DeviceMesher>(*this); }

DeviceMap* DevicePipeline::MirrorOf(const BlockMap& map) {
    if (map_ && mirrored_ == map.identity()) return map_.get();
    TESSERA_CHECK(map.count() == map.size() - 1, "{} blocks under {} ids", map.count(), map.size());
    mirrored_ = 0;
    map_ = std::make_unique<DeviceMap>(map.config().voxel_size_m, map.config().truncation_m, memory_, stream_);
    if (!map_->Load(map.size(), map.view().coords, map.field(0), map.weight(0), map.colour(0))) map_.reset();
    if (map_) mirrored_ = map.identity();
    return map_.get();
}

bool DevicePipeline::Upload(const PreparedFrame& frame) {
    const std::size_t pixels = frame.depth_m.size();
    if (!depth_m_.ReserveScratch(stream_, pixels) || !packed_colour_.ReserveScratch(stream_, pixels) ||
        !tiles_.ReserveScratch(stream_, pixels))
        return false;
    stream_.Upload(depth_m_.data(), frame.depth_m.data(), pixels * sizeof(float));
    if (frame.has_colour()) stream_.Upload(packed_colour_.data(), frame.packed_colour.data(), pixels * sizeof(std::uint32_t));
    return true;
}

bool DevicePipeline::ReservePoints(int count) {
    const auto points = static_cast<std::size_t>(count);
    bool room = sums_.Reserve(stream_, SumLayout::kCount, 0) && sum_tiles_.ReserveScratch(stream_, TilesOfPoints(count));
    for (auto* buffer : {&x_, &y_, &z_, &intensity_, &weight_, &distance_residual_, &intensity_residual_})
        room = room && buffer->ReserveScratch(stream_, points);
    return room;
}

void DevicePipeline::SetPoints(const BlockMap& map, const FramePoints& points) {
    points_ = points.count();
    has_distance_residual_ = has_intensity_residual_ = false;
    if (MirrorOf(map) == nullptr || !ReservePoints(points_)) {
        points_ = 0;  // what has no room is not tracked: the sums are empty, and the frame is lost
        return;
    }
    const auto upload = [this](DeviceBuffer<float>& to, const std::vector<float>& from) {
        stream_.Upload(to.data(), from.data(), from.size() * sizeof(float));
    };
    upload(x_, points.x);
    upload(y_, points.y);
    upload(z_, points.z);
    upload(intensity_, points.intensity);
    upload(weight_, points.weight);
}

PoseSums DevicePipeline::Sum(const SdfArguments& arguments) {
    PoseSums sums;
    if (points_ == 0) return sums;
    SdfArguments a = arguments;
    static_cast<BlockMapView&>(a) = map_->view().readable();
    a.x = x_.data();
    a.y = y_.data();
    a.z = z_.data();
    a.intensity = intensity_.data();
    a.weight = weight_.data();
    has_distance_residual_ = a.distance_residual != nullptr;
    has_intensity_residual_ = a.intensity_residual != nullptr;
    if (has_distance_residual_) a.distance_residual = distance_residual_.data();
    if (has_intensity_residual_) a.intensity_residual = intensity_residual_.data();
    SumSdfPoints(stream_, a, points_, sum_tiles_.data(), sums_.data());
    stream_.Download(sums.value, sums_.data(), sizeof sums.value);
    stream_.Wait();
    return sums;
}

void DevicePipeline::TakeResiduals(std::vector<float>& distance, std::vector<float>& intensity) {
    const std::size_t bytes = static_cast<std::size_t>(points_) * sizeof(float);
    if (has_distance_residual_) stream_.Download(distance.data(), distance_residual_.data(), bytes);
    if (has_intensity_residual_) stream_.Download(intensity.data(), intensity_residual_.data(), bytes);
    stream_.Wait();
}

}  // namespace tessera::TESSERA_DEVICE
