// The device backend as the stages of src/system see it: an Integrator that allocates and fuses on
// the device, a BlockMesher, the trackers' sums and predicted views. All work on one map, which
// mirrors the stage's BlockMap. Blocks are added to both at once; voxels are copied back on request
// (Integrator::Bring).
#pragma once

#include "cuda/device_frame.h"
#include "cuda/device_icp.h"
#include "cuda/device_map.h"
#include "cuda/device_points.h"
#include "cuda/device_residuals.h"
#include "cuda/device_views.h"
#include "system/backend.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only, including everything that it makes.
class DevicePipeline : public Backend, public SdfSums {
  public:
    // `limit_bytes`: limit of all device memory in use.
    DevicePipeline(std::string name, std::size_t limit_bytes);

    std::string name() const override { return name_; }
    bool on_device() const override { return true; }
    void Prepare(const Frame& frame, const PreparedFrame::Config& config, const MovingMask* moving,
                 bool keep_images, PreparedFrame& prepared) override;
    void Remask(const Frame& frame, const PreparedFrame::Config& config, const MovingMask* moving,
                bool keep_images, PreparedFrame& prepared) override {
        Prepare(frame, config, moving, keep_images, prepared);
    }
    std::unique_ptr<Integrator> MakeIntegrator(const Integrator::Config& config,
                                               const PinholeCamera& camera) override;
    std::unique_ptr<BlockMesher> MakeBlockMesher() override;
    SdfSums& sdf_sums() override { return *this; }
    DeviceIcp& icp_sums() override { return icp_; }
    ViewPredictor& views() override { return views_; }

    void SetPoints(const BlockMap& map, const PreparedFrame& frame, const PointArguments& arguments,
                   FramePoints& slots) override;
    PoseSums Sum(const SdfArguments& arguments, int points) override;
    ResidualSums SumResiduals(const ResidualArguments& arguments) override;
    void RemoveShading(const ShadingArguments& arguments) override;

    // For inspection: copies the points without their normals into arrays that Lay has made, and
    // the last Sum's residuals.
    void TakePoints(FramePoints& points) { Download(points_, points); }
    void TakeResiduals(std::vector<float>& distance, std::vector<float>& intensity);

    std::size_t limit_bytes() const { return memory_.limit_bytes(); }
    std::size_t used_bytes() const { return memory_.used_bytes(); }

  private:
    friend class DeviceIntegrator;
    friend class DeviceViews;
    friend class DeviceIcp;
    friend class DeviceMesher;

    // Returns the device's copy of this map. Copies the map first if the device holds another one
    // (by BlockMap::identity). Null: no room.
    DeviceMap* MirrorOf(const BlockMap& map);
    // Makes the frame's points on the device, like DevicePoints::Build.
    [[nodiscard]] std::int64_t MakePoints(const PreparedFrame& frame,
                                          const PointArguments& arguments, DevicePoints& points);
    // Sums over these points and residuals (PointResiduals, one array after the other) and the
    // frame, all of which are on the device.
    [[nodiscard]] ResidualSums SumResidualsOf(ResidualArguments arguments,
                                              const DevicePoints& points, const float* residuals);
    // The same for RemoveShading; the points' intensities change.
    void RemoveShadingOf(ShadingArguments arguments, DevicePoints& points, const float* residuals);
    // Copies all but the normals into arrays that Lay has made.
    void Download(const DevicePoints& from, FramePoints& points);
    [[nodiscard]] bool ReserveSums(int points);

    std::string name_;
    Stream stream_;
    DeviceMemory memory_;
    std::unique_ptr<DeviceMap> map_;
    std::uint64_t mirrored_ = 0;  // identity of the mirrored map; 0 = none
    DeviceFrame frame_;
    DevicePoints points_;
    DeviceResiduals residual_sums_;
    DeviceBuffer<float> residuals_;  // PointResiduals, one array after the other
    DeviceBuffer<double> sum_tiles_, sums_;
    bool has_distance_residual_ = false, has_intensity_residual_ = false;
    DeviceViews views_;
    DeviceIcp icp_;
};

}  // namespace tessera::TESSERA_DEVICE
