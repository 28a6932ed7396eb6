#include "cuda/device_views.h"

#include "cuda/device_pipeline.h"
#include "cuda/device_rays.h"
#include "mapping/ray_caster.h"

namespace tessera::TESSERA_DEVICE {

DeviceViews::DeviceViews(DevicePipeline& device)
    : device_(device),
      ranges_(device.memory_),
      depth_m_(device.memory_),
      normal_(device.memory_),
      intensity_(device.memory_),
      rgb_(device.memory_) {}

bool DeviceViews::Reserve(std::size_t tiles) {
    Stream& stream = device_.stream_;
    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    return ranges_.ReserveScratch(stream, tiles) && depth_m_.ReserveScratch(stream, pixels) &&
           normal_.ReserveScratch(stream, 3 * pixels) &&
           intensity_.ReserveScratch(stream, pixels) && rgb_.ReserveScratch(stream, 3 * pixels);
}

bool DeviceViews::Cast(const BlockMap& map, const PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                       float max_depth_m) {
    width_ = camera.width;
    height_ = camera.height;
    const RangeArguments range =
        MakeRangeArguments(map, camera, T_world_camera, min_depth_m,
                           std::min(max_depth_m, FarthestRayDepth(map.config(), camera)));
    DeviceMap* mirror = device_.MirrorOf(map);
    if (mirror == nullptr || !Reserve(static_cast<std::size_t>(range.width * range.height)))
        return false;
    const DeviceMapView layers = mirror->view();
    FindRayRanges(device_.stream_, range, layers.coords, mirror->size(), ranges_.data());
    RayArguments a = MakeRayArguments(map.config(), camera, T_world_camera);
    static_cast<BlockMapView&>(a) = layers.readable();
    a.colour = layers.colour;
    a.depth_m = depth_m_.data();
    a.normal_camera = normal_.data();
    a.rgb = rgb_.data();
    a.intensity = intensity_.data();
    CastRays(device_.stream_, a, ranges_.data());
    return true;
}

void DeviceViews::Predict(const BlockMap& map, const PinholeCamera& camera,
                          const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                          float max_depth_m, PredictedView& view) {
    view.Resize(camera, T_world_camera);
    if (!Cast(map, camera, T_world_camera, min_depth_m, max_depth_m)) return view.SetNothing();
    const auto download = [&](auto& image, const void* from) {
        device_.stream_.Download(image.data(), from, image.size() * sizeof *image.data());
    };
    download(view.depth_m, depth_m_.data());
    download(view.normal_camera, normal_.data());
    download(view.colour, rgb_.data());
    download(view.intensity, intensity_.data());
    device_.stream_.Wait();
}

}  // namespace tessera::TESSERA_DEVICE
