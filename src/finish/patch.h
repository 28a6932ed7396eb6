// Bounds of a small part of a surface, which tell quickly that a view shows nothing of it.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "finish/texture_view.h"

namespace tessera {

struct Patch {
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();  // world
    float radius_m = 0;                                // of a ball that has all points
    Eigen::Vector3f axis = Eigen::Vector3f::UnitZ();   // about the mean normal
    float spread_rad = 0;                              // largest angle between a normal and it
};

// `points` have a point and a unit normal each, and are not empty.
template <class Points>
Patch PatchOf(const Points& points) {
    Patch patch;
    Eigen::AlignedBox3f box;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const auto& p : points) {
        box.extend(p.point);
        sum += p.normal;
    }
    patch.centre = box.center();
    patch.radius_m = 0.5f * box.diagonal().norm();
    if (sum.norm() > 1e-6f) patch.axis = sum.normalized();
    float least = 1;
    for (const auto& p : points) least = std::min(least, p.normal.dot(patch.axis));
    patch.spread_rad = std::acos(std::clamp(least, -1.0f, 1.0f));
    return patch;
}

// False only if See has no weight at any point of the patch. Thread-safe.
bool MayShow(const TextureView& view, const Patch& patch);

}  // namespace tessera
