// The tree of coordinate frames that a ROS recording describes, as far as its frames do not move.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "recordings/ros_message.h"

namespace tessera {

// Thread-safe for reading.
class RosTransforms {
  public:
    // Keeps the first transform of each child frame; one that is known to be static replaces one
    // that is not.
    void Add(const RosTransform& transform, bool is_static);
    // p_to = T_to_from * p_from. nullopt if the frames are not connected.
    std::optional<Eigen::Isometry3d> Between(std::string_view to, std::string_view from) const;

  private:
    struct Link {
        std::string parent;
        Eigen::Isometry3d T_parent_child;
        bool is_static;
    };
    // The transform to the frame's root, and the root's name.
    std::pair<std::string, Eigen::Isometry3d> ToRoot(std::string_view frame) const;

    std::map<std::string, Link, std::less<>> links_;  // by child
};

}  // namespace tessera
