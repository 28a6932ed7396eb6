// BlockMesher on the device. Made by DevicePipeline.
#pragma once

#include <optional>

#include "cuda/device_pipeline.h"
#include "cuda/device_surface.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only.
class DeviceMesher : public BlockMesher {
  public:
    explicit DeviceMesher(DevicePipeline& device);

    bool MeshBlocks(const BlockMap& map, std::span<const BlockId> blocks, double min_weight,
                    BlockMeshes& meshes) override;

  private:
    DevicePipeline& device_;
    std::optional<DeviceSurface> surface_;
    SurfaceArrays arrays_;
};

}  // namespace tessera::TESSERA_DEVICE
