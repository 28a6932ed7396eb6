// A GPU that keeps the map and does the work over its voxels, over rays through it and over a
// frame's pixels and points, in the processor's place.
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

// Owner thread only, with all that it makes.
class Device {
  public:
    virtual ~Device() = default;

    virtual std::string name() const = 0;
    // As PrepareFrame, but the images stay there, apart from the reduced ones, unless `bring`.
    virtual void Prepare(const Frame& frame, const PreparedFrame::Config& config, bool bring,
                         PreparedFrame& prepared) = 0;
    // Fuses there. The device outlives it.
    virtual std::unique_ptr<Integrator> MakeIntegrator(const Integrator::Config& config,
                                                       const PinholeCamera& camera) = 0;
    // Meshes the map that the integrator fuses into there. The device outlives it. Null: the
    // processor meshes.
    virtual std::unique_ptr<BlockMesher> MakeBlockMesher() = 0;
    // Sums over the map that the integrator fuses into.
    virtual SdfSums& sdf_sums() = 0;
    // The same of views of that map.
    virtual IcpSums& icp_sums() = 0;
    // Casts rays there, as RayCaster does; where there is no room nothing is seen.
    virtual ViewPredictor& views() = 0;
};

}  // namespace tessera
