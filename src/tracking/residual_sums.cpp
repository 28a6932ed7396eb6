#include "tracking/residual_sums.h"

#include <tbb/parallel_for.h>

namespace tessera {
namespace {

template <class Kind>
std::vector<double> SumKind(const ResidualArguments& a) {
    std::vector<double> sums(static_cast<std::size_t>(Kind::Groups(a) * Kind::kSums), 0.0);
    tbb::parallel_for(0, Kind::Groups(a), [&](int group) {
        double* total = sums.data() + group * Kind::kSums;
        for (int part = 0; part < Kind::Parts(a); ++part) {
            double of_part[Kind::kSums] = {};
            Kind::Add(a, group, part, of_part);
            for (int k = 0; k < Kind::kSums; ++k) total[k] += of_part[k];
        }
    });
    return sums;
}

}  // namespace

void PointResiduals::Resize(int points) {
    distance_m.resize(static_cast<std::size_t>(points));
    intensity.resize(static_cast<std::size_t>(points));
    for (auto& values : gradient) values.resize(static_cast<std::size_t>(points));
}

ResidualArguments MakeResidualArguments(const PreparedFrame& frame, const PinholeCamera& camera,
                                        const FramePoints& points,
                                        const PointResiduals& residuals) {
    ResidualArguments a{};
    a.width = points.width();
    a.height = points.height();
    a.step = points.step();
    a.x = points.x.data();
    a.y = points.y.data();
    a.z = points.z.data();
    a.intensity = points.intensity.data();
    a.weight = points.weight.data();
    a.distance_residual = residuals.distance_m.data();
    a.intensity_residual = residuals.intensity.data();
    for (std::size_t k = 0; k < 3; ++k) a.gradient[k] = residuals.gradient[k].data();
    a.image = frame.intensity.data();
    a.image_width = frame.width;
    a.image_height = frame.height;
    a.fx = camera.fx;
    a.fy = camera.fy;
    a.cx = camera.cx;
    a.cy = camera.cy;
    return a;
}

ResidualSums SumResiduals(const ResidualArguments& a) {
    ResidualSums sums;
    sums.distances = SumKind<DistanceSums>(a);
    if (a.has_intensity) sums.scores = SumKind<ScoreSums>(a);
    if (a.wants_shutter) sums.shutter = SumKind<ShutterSums>(a);
    return sums;
}

ShadingArguments MakeShadingArguments(FramePoints& points, const PointResiduals& residuals,
                                      double gain, double limit) {
    ShadingArguments a{};
    a.width = points.width();
    a.height = points.height();
    a.residual = residuals.intensity.data();
    a.intensity = points.intensity.data();
    a.gain = static_cast<float>(gain);
    a.limit = static_cast<float>(limit);
    return a;
}

void RemoveShading(ShadingArguments a) {
    std::vector<float> patches(3 * static_cast<std::size_t>(a.Patches()));
    a.sum = patches.data();
    a.count = a.sum + a.Patches();
    a.mean = a.count + a.Patches();
    tbb::parallel_for(0, a.Rows(), [&](int row) {
        for (int i = row * a.Columns(); i < (row + 1) * a.Columns(); ++i)
            ShadingKernels::SumPatch(a, i);
    });
    for (int i = 0; i < a.Patches(); ++i) ShadingKernels::MeanAround(a, i);
    tbb::parallel_for(0, a.height, [&](int row) {
        for (int i = row * a.Columns(); i < (row + 1) * a.Columns(); ++i)
            ShadingKernels::AddShading(a, i);
    });
}

}  // namespace tessera
