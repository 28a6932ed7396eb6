// The ICP tracker's model and sums on the device. Made by DevicePipeline.
#pragma once

#include "cuda/device_points.h"
#include "cuda/device_residuals.h"
#include "tracking/icp_sums.h"
#include "tracking/model_kernels.h"

namespace tessera::TESSERA_DEVICE {

class DevicePipeline;

// Owner thread only. If the device has no room, the sums are empty and the frame is lost.
class DeviceIcp : public IcpSums {
  public:
    explicit DeviceIcp(DevicePipeline& device);

    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, const ModelRange& range, int levels,
                 PredictedView& view, std::vector<IcpModelLevel>& model) override;
    void SetModel(const std::vector<IcpModelLevel>& levels) override;
    void SetPoints(const PreparedFrame& frame, const PointArguments& arguments, int level,
                   FramePoints& slots) override;
    PoseSums Sum(const IcpArguments& arguments, int points) override;
    void KeepResiduals(PointResiduals&, PointResiduals&) override { kept_ = 1 - kept_; }
    ResidualSums SumResiduals(const ResidualArguments& arguments) override;
    void RemoveShading(const ShadingArguments& arguments) override;

    // Like those of DevicePipeline, for the kept residuals.
    void TakePoints(FramePoints& points);
    void TakeResiduals(std::vector<float>& distance, std::vector<float>& intensity);

    // The model's levels, with their images on the device.
    const std::vector<ModelImages>& model() const { return model_; }

  private:
    // Makes room for the images of this many levels, the finest of this size. ImagesOf returns the
    // images of a level.
    void CastModel(const BlockMap& map, const PinholeCamera& camera,
                   const Eigen::Isometry3d& T_world_camera, const ModelRange& range, int levels);
    [[nodiscard]] bool ReserveSums(int points);
    [[nodiscard]] bool ReserveModel(const PinholeCamera& finest, int levels);
    struct Images {
        float *depth_m, *normal, *intensity;
    };
    Images ImagesOf(int level);
    float* Residuals(int set, int kind) {
        return residuals_.data() + (kPointResiduals * set + kind) * points_.count();
    }

    DevicePipeline& device_;
    std::vector<ModelImages> model_;  // per level; empty if there is no room
    std::size_t pixels_ = 0;          // of the finest level
    std::size_t level_ = 0;           // of the points
    DevicePoints points_;
    DeviceBuffer<float> model_pixels_;
    DeviceBuffer<float> residuals_;  // two sets of PointResiduals, one array after the other
    int kept_ = 0;                   // index of the kept set; the other is the last sum's
    bool has_intensities_ = false;
    DeviceBuffer<double> sum_tiles_, sums_;
};

}  // namespace tessera::TESSERA_DEVICE
