// The processor's portable path as a Device for the ICP trackers: what a run on a device is held
// against where the processor's own, on its vectors, would round otherwise.
#pragma once

#include "mapping/ray_caster.h"
#include "system/device.h"
#include "tracking/icp_rows.h"

namespace tessera::testing_support {

class PortableDevice : public Device, public IcpSums {
  public:
    std::string name() const override { return "portable"; }
    std::unique_ptr<Integrator> MakeIntegrator(const Integrator::Config& config,
                                               const PinholeCamera& camera) override {
        return std::make_unique<Integrator>(config, camera, VectorPath::kBaseline);
    }
    std::unique_ptr<BlockMesher> MakeBlockMesher() override { return nullptr; }
    SdfSums& sdf_sums() override { std::abort(); }
    IcpSums& icp_sums() override { return *this; }
    ViewPredictor& views() override { return caster_; }

    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 int levels, float jump_m) override {
        caster_.Predict(map, camera, T_world_camera, min_depth_m, max_depth_m, view_);
        BuildIcpModel(view_, levels, jump_m, model_);
    }
    void SetModel(const std::vector<IcpModelLevel>& levels) override { model_ = levels; }
    void SetPoints(const FramePoints& points, int level) override {
        points_ = &points;
        level_ = static_cast<std::size_t>(level);
        for (Residuals* r : {&kept_, &last_}) {
            r->distance.resize(static_cast<std::size_t>(points.count()));
            r->intensity.resize(static_cast<std::size_t>(points.count()));
        }
    }
    // The points' arrays are the tracker's own.
    PoseSums Sum(const IcpArguments& arguments) override {
        IcpArguments a = arguments;
        a.depth = model_[level_].depth_m.data();
        a.normal = model_[level_].normal_camera.data()->data();
        a.intensity = model_[level_].intensity.data();
        a.distance_residual = last_.distance.data();
        a.intensity_residual = last_.intensity.data();
        if (a.distance_before != nullptr) {
            a.distance_before = kept_.distance.data();
            a.intensity_before = kept_.intensity.data();
        }
        return SumPoints(points_->count(), [&](int begin, int end, double* sums) {
            baseline::SumIcpPoints(a, begin, end, sums);
        });
    }
    void KeepResiduals() override { std::swap(kept_, last_); }
    void TakeResiduals(std::vector<float>& distance, std::vector<float>& intensity) override {
        distance = kept_.distance;
        intensity = kept_.intensity;
    }

  private:
    struct Residuals {
        std::vector<float> distance, intensity;
    };

    RayCaster caster_{VectorPath::kBaseline};
    PredictedView view_;
    std::vector<IcpModelLevel> model_;
    const FramePoints* points_ = nullptr;
    std::size_t level_ = 0;
    Residuals kept_, last_;
};

}  // namespace tessera::testing_support
