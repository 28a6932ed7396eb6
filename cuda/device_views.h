// Predicted views of the map on the device, like mapping/ray_caster.h. Made by DevicePipeline.
#pragma once

#include "cuda/device_map.h"
#include "mapping/predicted_view.h"
#include "mapping/range_kernels.h"
#include "tracking/model_kernels.h"

namespace tessera::TESSERA_DEVICE {

class DevicePipeline;

// Owner thread only.
class DeviceViews : public ViewPredictor {
  public:
    explicit DeviceViews(DevicePipeline& device);

    // Leaves the view on the device. Returns false if there is no room.
    [[nodiscard]] bool Cast(const BlockMap& map, const PinholeCamera& camera,
                            const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                            float max_depth_m);
    // The last view that was cast, on the device.
    ModelImages images() const {
        return {depth_m_.data(), normal_.data(), intensity_.data(), width_, height_};
    }

    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 PredictedView& view) override;

  private:
    [[nodiscard]] bool Reserve(std::size_t tiles);

    DevicePipeline& device_;
    int width_ = 0, height_ = 0;
    DeviceBuffer<RayRange> ranges_;  // per tile
    DeviceBuffer<float> depth_m_, normal_, intensity_;
    DeviceBuffer<std::uint8_t> rgb_;
};

}  // namespace tessera::TESSERA_DEVICE
