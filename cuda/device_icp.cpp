#include "cuda/device_icp.h"

#include "cuda/device_pipeline.h"
#include "cuda/device_rays.h"
#include "cuda/device_sums.h"

namespace tessera::TESSERA_DEVICE {
namespace {

constexpr std::size_t kModelFloats = 5;  // per pixel

}  // namespace

DeviceIcp::DeviceIcp(DevicePipeline& device)
    : device_(device),
      points_(device.memory_, device.stream_),
      model_pixels_(device.memory_),
      residuals_(device.memory_),
      sum_tiles_(device.memory_),
      sums_(device.memory_) {}

bool DeviceIcp::ReserveModel(const PinholeCamera& finest, int levels) {
    model_.clear();
    pixels_ = static_cast<std::size_t>(finest.width) * static_cast<std::size_t>(finest.height);
    return model_pixels_.ReserveScratch(device_.stream_,
                                        kModelFloats * pixels_ * static_cast<std::size_t>(levels));
}

DeviceIcp::Images DeviceIcp::ImagesOf(int level) {
    float* at = model_pixels_.data() + kModelFloats * pixels_ * static_cast<std::size_t>(level);
    return {at, at + pixels_, at + 4 * pixels_};
}

void DeviceIcp::Predict(const BlockMap& map, const PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera, const ModelRange& range,
                        int levels, PredictedView& view, std::vector<IcpModelLevel>& model) {
    view.camera = camera;
    view.T_world_camera = T_world_camera;
    model.resize(static_cast<std::size_t>(levels));
    for (std::size_t i = 0; i < model.size(); ++i)
        model[i].camera = i == 0 ? camera : HalfOf(model[i - 1].camera);
    CastModel(map, camera, T_world_camera, range, levels);
}

void DeviceIcp::CastModel(const BlockMap& map, const PinholeCamera& camera,
                          const Eigen::Isometry3d& T_world_camera, const ModelRange& range,
                          int levels) {
    if (!ReserveModel(camera, levels) ||
        !device_.views_.Cast(map, camera, T_world_camera, range.near_m, range.far_m))
        return;
    ModelImages finest = device_.views_.images();
    TrustIntensities(device_.stream_, finest, range.jump_m, ImagesOf(0).intensity);
    finest.intensity = ImagesOf(0).intensity;
    model_.push_back(finest);
    for (int i = 1; i < levels; ++i) {
        const ModelImages fine = model_.back();
        const auto [depth_m, normal, intensity] = ImagesOf(i);
        HalveModel(device_.stream_, fine, range.jump_m, depth_m, normal, intensity);
        model_.push_back({depth_m, normal, intensity, fine.width / 2, fine.height / 2});
    }
}

void DeviceIcp::SetModel(const std::vector<IcpModelLevel>& levels) {
    if (!ReserveModel(levels.front().camera, static_cast<int>(levels.size()))) return;
    for (const IcpModelLevel& level : levels) {
        const auto [depth_m, normal, intensity] = ImagesOf(static_cast<int>(model_.size()));
        const std::size_t bytes = level.depth_m.size() * sizeof(float);
        device_.stream_.Upload(depth_m, level.depth_m.data(), bytes);
        device_.stream_.Upload(normal, level.normal_camera.data(), 3 * bytes);
        device_.stream_.Upload(intensity, level.intensity.data(), bytes);
        model_.push_back({depth_m, normal, intensity, level.camera.width, level.camera.height});
    }
}

void DeviceIcp::SetPoints(const PreparedFrame& frame, const PointArguments& arguments, int level,
                          FramePoints& slots) {
    level_ = static_cast<std::size_t>(level);
    has_intensities_ = false;
    points_.Clear();
    const bool room = ReserveSums(arguments.width * arguments.height);
    slots.Allocate(arguments, room ? device_.MakePoints(frame, arguments, points_) : 0);
}

bool DeviceIcp::ReserveSums(int points) {
    Stream& stream = device_.stream_;
    const auto count = static_cast<std::size_t>(points);
    return residuals_.ReserveScratch(stream, 2 * kPointResiduals * count) &&
           sum_tiles_.ReserveScratch(stream, TilesOfPoints(points)) &&
           sums_.Reserve(stream, SumLayout::kCount, 0);
}

void DeviceIcp::TakePoints(FramePoints& points) { device_.Download(points_, points); }

PoseSums DeviceIcp::Sum(const IcpArguments& arguments, int) {
    PoseSums sums;
    if (points_.count() == 0 || model_.empty()) return sums;
    IcpArguments a = arguments;
    const ModelImages& model = model_[level_];
    a.depth = model.depth_m;
    a.normal = model.normal;
    a.intensity = model.intensity;
    a.x = points_.x();
    a.y = points_.y();
    a.z = points_.z();
    a.normal_x = points_.normal_x();
    a.normal_y = points_.normal_y();
    a.normal_z = points_.normal_z();
    a.intensity_of_point = points_.intensity();
    a.weight = points_.weight();
    a.distance_residual = Residuals(1 - kept_, 0);
    a.intensity_residual = Residuals(1 - kept_, 1);
    for (int k = 0; k < 3; ++k) a.gradient[k] = Residuals(1 - kept_, 2 + k);
    const bool compare = arguments.distance_before != nullptr;
    a.distance_before = compare ? Residuals(kept_, 0) : nullptr;
    a.intensity_before = compare ? Residuals(kept_, 1) : nullptr;
    has_intensities_ = a.alpha > 0;
    SumIcpPoints(device_.stream_, a, points_.count(), sum_tiles_.data(), sums_.data());
    device_.stream_.Download(sums.value, sums_.data(), sizeof sums.value);
    device_.stream_.Wait();
    return sums;
}

ResidualSums DeviceIcp::SumResiduals(const ResidualArguments& arguments) {
    return device_.SumResidualsOf(arguments, points_, Residuals(kept_, 0));
}

void DeviceIcp::RemoveShading(const ShadingArguments& arguments) {
    device_.RemoveShadingOf(arguments, points_, Residuals(kept_, 0));
}

void DeviceIcp::TakeResiduals(std::vector<float>& distance, std::vector<float>& intensity) {
    const std::size_t bytes = static_cast<std::size_t>(points_.count()) * sizeof(float);
    device_.stream_.Download(distance.data(), Residuals(kept_, 0), bytes);
    if (has_intensities_) device_.stream_.Download(intensity.data(), Residuals(kept_, 1), bytes);
    device_.stream_.Wait();
}

}  // namespace tessera::TESSERA_DEVICE
