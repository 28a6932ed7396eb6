// The backend as the stages of src/system see it: an Integrator that allocates and fuses on the
// device, a BlockMesher, the trackers' sums and the predicted views there. All work on one map,
// which mirrors the stage's BlockMap: the blocks are in both at once, the voxels come over when
// somebody asks (Integrator::Bring).
#pragma once

#include "cuda/device_frame.h"
#include "cuda/device_icp.h"
#include "cuda/device_map.h"
#include "cuda/device_points.h"
#include "cuda/device_residuals.h"
#include "cuda/device_views.h"
#include "system/device.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only, with all that it makes.
class DevicePipeline : public Device, public SdfSums {
  public:
    // `limit_bytes`: of the device's memory, all counted.
    DevicePipeline(std::string name, std::size_t limit_bytes);

    std::string name() const override { return name_; }
    void Prepare(const Frame& frame, const PreparedFrame::Config& config, bool bring,
                 PreparedFrame& prepared) override;
    std::unique_ptr<Integrator> MakeIntegrator(const Integrator::Config& config,
                                               const PinholeCamera& camera) override;
    std::unique_ptr<BlockMesher> MakeBlockMesher() override;
    SdfSums& sdf_sums() override { return *this; }
    DeviceIcp& icp_sums() override { return icp_; }
    ViewPredictor& views() override { return views_; }

    std::int64_t SetPoints(const BlockMap& map, const PreparedFrame& frame,
                           const PointArguments& points) override;
    PoseSums Sum(const SdfArguments& arguments) override;
    ResidualSums SumResiduals(const ResidualArguments& arguments) override;

    // For who looks into it: the points without their normals, to what Lay has made for them, and
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

    // The device's map becomes that one's copy, if it is not yet: by BlockMap::identity. Null: no
    // room.
    DeviceMap* MirrorOf(const BlockMap& map);
    // The frame's points on the device, as DevicePoints::Build.
    [[nodiscard]] std::int64_t MakePoints(const PreparedFrame& frame,
                                          const PointArguments& arguments, DevicePoints& points);
    // Of those points and residuals (PointResiduals, one array after the other), which are there,
    // of the frame that is there.
    [[nodiscard]] ResidualSums SumResidualsOf(ResidualArguments arguments,
                                              const DevicePoints& points, const float* residuals);
    // All but the normals, to what Lay has made for them.
    void Download(const DevicePoints& from, FramePoints& points);
    [[nodiscard]] bool ReserveSums(int points);

    std::string name_;
    Stream stream_;
    DeviceMemory memory_;
    std::unique_ptr<DeviceMap> map_;
    std::uint64_t mirrored_ = 0;  // the map's identity; 0 = none
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
