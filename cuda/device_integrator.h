// Integrator on the device. Made by DevicePipeline.
#pragma once

#include "cuda/device_pipeline.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only.
class DeviceIntegrator : public Integrator {
  public:
    DeviceIntegrator(DevicePipeline& device, const Config& config, const PinholeCamera& camera);

    void Bring(BlockMap& map) override;
    std::string limit() const override;

  protected:
    void Allocate(const PreparedFrame& frame, const View& view, BlockMap& map,
                  Report& report) override;
    void Fuse(const PreparedFrame& frame, const View& view, BlockMap& map, Report& report) override;

  private:
    DevicePipeline& device_;
    bool uploaded_ = false;  // this call's frame is on the device, and the map is mirrored
    std::uint32_t brought_revision_ = 0;
    std::uint64_t brought_map_ = 0;  // identity of the map of brought_revision_
    std::vector<BlockId> changed_ids_;
    BlockVoxels voxels_;
};

}  // namespace tessera::TESSERA_DEVICE
