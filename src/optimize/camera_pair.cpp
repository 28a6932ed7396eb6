#include "optimize/camera_pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/quantile.h"
#include "optimize/bilinear.h"

namespace tessera {
namespace {

// Depths that differ by a larger share belong to different surfaces.
constexpr double kNearestPoint_m = 0.1, kOccluded = 0.1;
constexpr double kLeastScale = 0.003;

// Velocity of a point in the frame of a camera that moves with `velocity`, scaled by the row's
// share of the read-out time.
Eigen::Vector3d RowMotion(const Vector6d& velocity, double row, const Eigen::Vector3d& p) {
    return row * (velocity.head<3>().cross(p) + velocity.tail<3>());
}

// Brightness at a pixel relative to the centre, and its derivatives.
struct Falloff {
    double value, du, dv;
    double radius2;  // 1 in the corners

    Falloff(const PinholeCamera& c, double u, double v, double vignetting) {
        const double x = u - 0.5 * (c.width - 1), y = v - 0.5 * (c.height - 1);
        const double corner2 =
            0.25 * ((c.width - 1.0) * (c.width - 1.0) + (c.height - 1.0) * (c.height - 1.0));
        radius2 = (x * x + y * y) / corner2;
        value = std::max(1 - vignetting * radius2, 0.05);
        du = -2 * vignetting * x / corner2;
        dv = -2 * vignetting * y / corner2;
    }
};

}  // namespace

PinholeCamera CameraUnknowns::Applied(const PinholeCamera& given) const {
    PinholeCamera camera = given;
    camera.fx *= std::exp(log_focal);
    camera.fy *= std::exp(log_focal);
    camera.cx += centre_x * given.width;
    camera.cy += centre_y * given.width;
    return camera;
}

void CameraUnknowns::Add(const Eigen::Matrix<double, kCount, 1>& step) {
    log_focal += step(0);
    centre_x += step(1);
    centre_y += step(2);
    readout_s += step(3);
    vignetting = std::clamp(vignetting + step(4), -0.5, 0.9);
}

bool EvaluatePoint(const CameraViewPoint& point, const CameraView::Level& to,
                   const PinholeCamera& camera, const CameraPair& pair,
                   const CameraUnknowns& unknowns, CameraPairResidual& residual) {
    const PinholeCamera& c = camera;
    const double readout_s = unknowns.readout_s;
    Eigen::Vector3d p = c.Unproject(point.u, point.v, point.depth_m);
    const Eigen::Vector3d moved_from =
        RowMotion(pair.velocity_from, static_cast<double>(point.v) / c.height - 0.5, p);
    p += readout_s * moved_from;
    Eigen::Vector3d q = pair.T_to_from * p;
    if (q.z() < kNearestPoint_m) return false;
    const double row = c.Project(q).y() / c.height - 0.5;
    if (std::abs(row) > 1) return false;
    const Eigen::Vector3d moved_to = RowMotion(pair.velocity_to, row, q);
    q -= readout_s * moved_to;
    if (q.z() < kNearestPoint_m) return false;
    const Eigen::Vector2d pixel = c.Project(q);
    if (!(pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() < c.width - 2 && pixel.y() < c.height - 2))
        return false;
    const BilinearSample depth = SampleBilinear(to.depth_m, pixel.x(), pixel.y());
    if (depth.least <= 0 || std::abs(depth.value - q.z()) > kOccluded * q.z()) return false;
    const BilinearSample sample = SampleBilinear(to.intensity, pixel.x(), pixel.y());
    const Falloff there(c, pixel.x(), pixel.y(), unknowns.vignetting),
        here(c, point.u, point.v, unknowns.vignetting);
    const BilinearSample seen{sample.value / there.value,
                              (sample.du - sample.value * there.du / there.value) / there.value,
                              (sample.dv - sample.value * there.dv / there.value) / there.value,
                              sample.least};
    const double intensity = point.intensity / here.value;
    residual.value = seen.value - (1 + pair.gain) * intensity - pair.offset;

    const double inverse_z = 1 / q.z(), x = pixel.x() - c.cx, y = pixel.y() - c.cy;
    const Eigen::Vector3d by_q(seen.du * c.fx * inverse_z, seen.dv * c.fy * inverse_z,
                               -(seen.du * x + seen.dv * y) * inverse_z);
    const Eigen::Vector3d by_p = pair.T_to_from.linear().transpose() * by_q;
    auto& j = residual.jacobian;
    j.head<3>() = q.cross(by_q);
    j.segment<3>(3) = by_q;
    j(6) = -intensity;
    j(7) = -1;
    j(8) = seen.du * x + seen.dv * y - by_p.x() * p.x() - by_p.y() * p.y();
    j(9) = (seen.du - by_p.x() * point.depth_m / c.fx) * c.width;
    j(10) = (seen.dv - by_p.y() * point.depth_m / c.fy) * c.width;
    j(11) = by_p.dot(moved_from) - by_q.dot(moved_to);
    j(12) = seen.value * there.radius2 / there.value -
            (1 + pair.gain) * intensity * here.radius2 / here.value;
    return true;
}

CameraPairSums SumPair(const CameraView& from, const CameraView& to, int level,
                       const PinholeCamera& camera, const CameraUnknowns& unknowns,
                       const CameraPair& pair) {
    const auto at = static_cast<std::size_t>(level);
    const CameraView::Level& seen = to.levels[at];
    const PinholeCamera reduced = Averaged(unknowns.Applied(camera), seen.reduction);
    CameraPairSums sums;
    std::vector<double> sizes;
    CameraPairResidual residual;
    for (const CameraViewPoint& point : from.levels[at].points) {
        ++sums.points;
        if (!EvaluatePoint(point, seen, reduced, pair, unknowns, residual)) continue;
        ++sums.used;
        sizes.push_back(std::abs(residual.value));
        // Student's t weights with few degrees of freedom: moving, specular or occluded points get
        // little weight.
        const double in_scales = residual.value / pair.scale, size = 0.25 * in_scales * in_scales;
        const double weight = 1 / ((1 + size) * pair.scale * pair.scale);
        sums.error += std::log1p(size);
        sums.hessian.selfadjointView<Eigen::Upper>().rankUpdate(residual.jacobian, weight);
        sums.gradient[point.region] += residual.jacobian * (weight * residual.value);
    }
    sums.hessian.triangularView<Eigen::Lower>() = sums.hessian.transpose();
    if (sizes.empty()) return sums;
    sums.scale = std::max(1.4826 * Median(std::move(sizes)), kLeastScale);
    return sums;
}

}  // namespace tessera
