#include "recordings/ros_transforms.h"

namespace tessera {
namespace {

constexpr std::size_t kMostFrames = 10000;
constexpr int kMostLinks = 100;  // from a frame to its root

// ROS 1 wrote "/camera" and "camera" for the same frame.
std::string FrameName(std::string_view name) {
    if (name.starts_with('/')) name.remove_prefix(1);
    return std::string(name);
}

}  // namespace

void RosTransforms::Add(const RosTransform& transform, bool is_static) {
    const std::string child = FrameName(transform.child_frame_id);
    const auto found = links_.find(child);
    if (found != links_.end() ? found->second.is_static || !is_static
                              : links_.size() >= kMostFrames)
        return;
    links_.insert_or_assign(
        child, Link{FrameName(transform.header.frame_id), transform.T_frame_child, is_static});
}

std::pair<std::string, Eigen::Isometry3d> RosTransforms::ToRoot(std::string_view frame) const {
    std::string at = FrameName(frame);
    Eigen::Isometry3d T_at_frame = Eigen::Isometry3d::Identity();
    for (int i = 0; i < kMostLinks; ++i) {
        const auto link = links_.find(at);
        if (link == links_.end()) break;
        T_at_frame = link->second.T_parent_child * T_at_frame;
        at = link->second.parent;
    }
    return {at, T_at_frame};
}

std::optional<Eigen::Isometry3d> RosTransforms::Between(std::string_view to,
                                                        std::string_view from) const {
    if (FrameName(to) == FrameName(from)) return Eigen::Isometry3d::Identity();
    const auto [to_root, T_root_to] = ToRoot(to);
    const auto [from_root, T_root_from] = ToRoot(from);
    if (to_root != from_root) return std::nullopt;
    return T_root_to.inverse() * T_root_from;
}

}  // namespace tessera
