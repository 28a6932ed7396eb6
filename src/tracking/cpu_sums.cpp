#include <utility>

#include "tracking/icp_simd.h"
#include "tracking/icp_sums.h"
#include "tracking/sdf_simd.h"
#include "tracking/sdf_sums.h"

namespace tessera {

void CpuSdfSums::SetPoints(const BlockMap&, const PreparedFrame&, const PointArguments& arguments,
                           FramePoints& slots) {
    slots.Build(arguments);
}

PoseSums CpuSdfSums::Sum(const SdfArguments& arguments, int points) {
    return SumPoints(points, [&](int first, int last, double* sums) {
        TESSERA_SIMD(path_, SumSdfPoints)(arguments, first, last, sums);
    });
}

ResidualSums CpuSdfSums::SumResiduals(const ResidualArguments& arguments) {
    return tessera::SumResiduals(arguments);
}

void CpuSdfSums::RemoveShading(const ShadingArguments& arguments) {
    tessera::RemoveShading(arguments);
}

void CpuIcpSums::Predict(const BlockMap& map, const PinholeCamera& camera,
                         const Eigen::Isometry3d& T_world_camera, const ModelRange& range,
                         int levels, PredictedView& view, std::vector<IcpModelLevel>& model) {
    caster_.Predict(map, camera, T_world_camera, range.near_m, range.far_m, view);
    BuildIcpModel(view, levels, range.jump_m, model);
}

void CpuIcpSums::SetPoints(const PreparedFrame&, const PointArguments& arguments, int,
                           FramePoints& slots) {
    slots.Build(arguments);
}

PoseSums CpuIcpSums::Sum(const IcpArguments& arguments, int points) {
    return SumPoints(points, [&](int first, int last, double* sums) {
        TESSERA_SIMD(path_, SumIcpPoints)(arguments, first, last, sums);
    });
}

void CpuIcpSums::KeepResiduals(PointResiduals& kept, PointResiduals& last) {
    std::swap(kept, last);
}

ResidualSums CpuIcpSums::SumResiduals(const ResidualArguments& arguments) {
    return tessera::SumResiduals(arguments);
}

void CpuIcpSums::RemoveShading(const ShadingArguments& arguments) {
    tessera::RemoveShading(arguments);
}

}  // namespace tessera
