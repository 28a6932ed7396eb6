#include "viz/cut_plane.h"

namespace tessera {

std::optional<Eigen::Vector4d> CutPlane(const ViewChoices& view, const Eigen::AlignedBox3d& bounds,
                                        const Eigen::Vector3d& up) {
    if (view.cut == Cut::kNone || bounds.isEmpty()) return std::nullopt;
    const Eigen::Vector3d towards = view.cut == Cut::kAbove ? up : view.cut_towards;
    const Eigen::Vector3d half = 0.5 * bounds.sizes();
    const double middle = towards.dot(bounds.center()), reach = towards.cwiseAbs().dot(half);
    constexpr double kBeyond = 1.05;  // so that the slider's ends are clearly outside
    const double at = middle + kBeyond * (2 * view.cut_at - 1) * reach;
    return Eigen::Vector4d(-towards.x(), -towards.y(), -towards.z(), at);
}

}  // namespace tessera
