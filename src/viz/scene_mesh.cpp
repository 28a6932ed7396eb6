#include "viz/scene_mesh.h"

#include <epoxy/gl.h>

#include "semantics/objects_file.h"

namespace tessera {

void SceneMesh::SetModel(const ViewedModel& model, const Eigen::Vector3d& up) {
    model_.Set(model.mesh, model.mesh.labels.empty() ? std::vector<Rgb8>()
                                                     : CategoryColours(model.mesh, model.objects));
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3f& vertex : model.mesh.vertices) bounds.extend(vertex.cast<double>());
    if (!bounds.isEmpty()) surface_->bounds.Extend(bounds);
    surface_->up = UpEstimator(up);
    for (const Eigen::Vector3f& normal : model.mesh.normals) surface_->up.Add(normal);
}

bool SceneMesh::Take(ViewerLink& link, std::size_t most_bytes) {
    std::size_t bytes = 0;
    bool any = false;
    while (bytes < most_bytes) {
        if (pending_done_ == pending_.blocks.size() && !NextUpdate(link)) break;
        bytes += Upload(most_bytes - bytes);
        if (pending_done_ == pending_.blocks.size()) {
            if (pending_.whole) before_.reset();
            is_final_ |= pending_.last;
        }
        any = true;
    }
    return any;
}

bool SceneMesh::NextUpdate(ViewerLink& link) {
    pending_done_ = 0;
    pending_.blocks.clear();
    if (!link.meshes.TryPop(pending_)) return false;
    link.system.Notify();  // there is room
    if (pending_.clear) {
        if (!before_ && surface_->store.triangles() > 0) before_ = std::move(surface_);
        surface_ = std::make_unique<Surface>(levels_);
    }
    return true;
}

// Uploads blocks of the pending update until that many bytes are reached. Returns their number.
std::size_t SceneMesh::Upload(std::size_t most_bytes) {
    const std::size_t first = pending_done_;
    std::size_t bytes = 0;
    for (; pending_done_ < pending_.blocks.size() && bytes < most_bytes; ++pending_done_) {
        const GeometryBlock& block = pending_.blocks[pending_done_];
        bytes += block.geometry.vertices.size() * sizeof(GeometryVertex) +
                 block.geometry.indices.size() * 2 + 64;
        if (block.geometry.indices.empty()) continue;
        surface_->up.Add(block.geometry);
        const double side_m = kBlockSide * pending_.voxel_size_m;
        const Eigen::Vector3d corner(block.coord.x, block.coord.y, block.coord.z);
        surface_->bounds.Extend(
            {corner * side_m, (corner + Eigen::Vector3d::Ones()).eval() * side_m});
    }
    const auto taken = std::span(pending_.blocks).subspan(first, pending_done_ - first);
    surface_->store.Replace(pending_.voxel_size_m, taken);
    surface_->coverage.Take(taken);
    return bytes;
}

void SceneMesh::Draw(const Eigen::Matrix4d& clip, const Eigen::Isometry3d& T_world_view,
                     int location) {
    (before_ ? before_ : surface_)->store.Draw(clip, T_world_view, location);
    model_.Draw(clip, T_world_view, location);
}

}  // namespace tessera
