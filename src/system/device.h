// A GPU backend: keeps the map on the GPU and runs the work over voxels, rays, frame pixels and
// points there instead of on the CPU.
#pragma once

#include <memory>
#include <string>

#include "core/config.h"
#include "mapping/block_mesher.h"
#include "mapping/integrator.h"
#include "mapping/predicted_view.h"
#include "mapping/prepared_frame.h"
#include "tracking/icp_sums.h"
#include "tracking/sdf_sums.h"

namespace tessera {

struct DeviceConfig {
    double memory_mb = 0;

    void Describe(ConfigParameters& parameters);
};

// Owner thread only, including every object it creates.
class Device {
  public:
    virtual ~Device() = default;

    virtual std::string name() const = 0;
    // Like PrepareFrame, but the images stay on the device unless `bring` is set. The reduced
    // images always come back.
    virtual void Prepare(const Frame& frame, const PreparedFrame::Config& config, bool bring,
                         PreparedFrame& prepared) = 0;
    // Fuses on the device. The device outlives the integrator.
    virtual std::unique_ptr<Integrator> MakeIntegrator(const Integrator::Config& config,
                                                       const PinholeCamera& camera) = 0;
    // Meshes the device copy of the map that the integrator fuses into. The device outlives it.
    // Null: the CPU meshes.
    virtual std::unique_ptr<BlockMesher> MakeBlockMesher() = 0;
    // Normal equations over the map that the integrator fuses into.
    virtual SdfSums& sdf_sums() = 0;
    // The same over predicted views of that map.
    virtual IcpSums& icp_sums() = 0;
    // Casts rays on the device, as RayCaster does. If device memory runs out, the view is empty.
    virtual ViewPredictor& views() = 0;
};

}  // namespace tessera
