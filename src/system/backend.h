// Where the work over voxels, rays, frame pixels and points runs: on the CPU, or on a GPU that also
// keeps the map. The stages know no other difference.
#pragma once

#include <memory>
#include <string>

#include "mapping/block_mesher.h"
#include "mapping/integrator.h"
#include "mapping/predicted_view.h"
#include "mapping/prepared_frame.h"
#include "tracking/icp_sums.h"
#include "tracking/sdf_sums.h"

namespace tessera {

// Owner thread only, including every object it creates.
class Backend {
  public:
    virtual ~Backend() = default;

    virtual std::string name() const = 0;
    // The voxels are on a device. A stage's BlockMap then has current blocks, but old voxels until
    // Integrator::Bring.
    virtual bool on_device() const = 0;
    // PrepareFrame without what moves (null: nothing). A device keeps the images, and copies them
    // to the CPU only if `keep_images` is set; the reduced images always come.
    virtual void Prepare(const Frame& frame, const PreparedFrame::Config& config,
                         const MovingMask* moving, bool keep_images, PreparedFrame& prepared) = 0;
    // The same with another mask, for a frame that was just prepared.
    virtual void Remask(const Frame& frame, const PreparedFrame::Config& config,
                        const MovingMask* moving, bool keep_images, PreparedFrame& prepared) = 0;
    // Neither is null. The backend outlives both.
    virtual std::unique_ptr<Integrator> MakeIntegrator(const Integrator::Config& config,
                                                       const PinholeCamera& camera) = 0;
    virtual std::unique_ptr<BlockMesher> MakeBlockMesher() = 0;
    // Normal equations over the map that the integrator fuses into, and over views of it.
    virtual SdfSums& sdf_sums() = 0;
    virtual IcpSums& icp_sums() = 0;
    // Casts rays as RayCaster does. If device memory runs out, the view is empty.
    virtual ViewPredictor& views() = 0;
};

class CpuBackend : public Backend {
  public:
    std::string name() const override { return "CPU"; }
    bool on_device() const override { return false; }
    void Prepare(const Frame& frame, const PreparedFrame::Config& config, const MovingMask* moving,
                 bool, PreparedFrame& prepared) override {
        PrepareFrame(frame, config, prepared, moving);
    }
    void Remask(const Frame& frame, const PreparedFrame::Config& config, const MovingMask* moving,
                bool, PreparedFrame& prepared) override {
        RemaskDepth(frame, config, prepared, moving);
    }
    std::unique_ptr<Integrator> MakeIntegrator(const Integrator::Config& config,
                                               const PinholeCamera& camera) override {
        return std::make_unique<Integrator>(config, camera);
    }
    std::unique_ptr<BlockMesher> MakeBlockMesher() override {
        return std::make_unique<CpuBlockMesher>();
    }
    SdfSums& sdf_sums() override { return sdf_; }
    IcpSums& icp_sums() override { return icp_; }
    ViewPredictor& views() override { return caster_; }

  private:
    CpuSdfSums sdf_;
    CpuIcpSums icp_;
    RayCaster caster_;
};

// The device's backend, or else a CpuBackend of its own.
class BackendOf {
  public:
    explicit BackendOf(Backend* device)
        : own_(device != nullptr ? nullptr : std::make_unique<CpuBackend>()),
          backend_(device != nullptr ? device : own_.get()) {}
    Backend* operator->() const { return backend_; }
    Backend& operator*() const { return *backend_; }

  private:
    std::unique_ptr<Backend> own_;
    Backend* backend_;
};

}  // namespace tessera
