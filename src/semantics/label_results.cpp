// Results of labelling: vertex labels and colours, and the objects.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <set>

#include "semantics/label_mapper.h"
#include "semantics/label_near.h"
#include "semantics/objects_file.h"

namespace tessera {
namespace {

// Minimum surface of an object in the map. Smaller ones are remains of false detections.
constexpr double kLeastArea_m2 = 0.0015;
constexpr double kLeastSeenShare = 0.1;  // of the mean area that its detections saw

}  // namespace

VertexLabel LabelMapper::LabelOf(const VoxelLabel& voxel) const {
    return ClassOf(voxel) == 0 ? VertexLabel{} : LabelOfInstance(voxel.instance);
}

VertexLabel LabelMapper::LabelOfInstance(InstanceId voted_for) const {
    if (voted_for == 0) return {};
    const InstanceId id = instances_.Resolve(voted_for);
    if (!instances_.stands(id)) return {};
    return {static_cast<std::uint8_t>(instances_.ClassOf(id)),
            static_cast<std::uint16_t>(instances_.record(id).public_id)};
}

void LabelMapper::LabelVertices(const BlockMap& map, TriangleMesh& mesh) const {
    mesh.labels.resize(mesh.vertices.size());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, mesh.vertices.size(), 4096), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                mesh.labels[i] = LabelOf(LabelNear(map, mesh.vertices[i].cast<double>()));
        });
}

VertexLabel LabelMapper::LabelOf(const BlockMap& map, const BlockMesh& owner,
                                 const BlockMesh::Vertex& vertex) const {
    return LabelOf(
        LabelNear(map, VertexPosition(owner, vertex, map.config().voxel_size_m).cast<double>()));
}

Rgb8 LabelMapper::ColourOf(const BlockMap& map, const BlockMesh& owner,
                           const BlockMesh::Vertex& vertex) const {
    if (const int class_id = LabelOf(map, owner, vertex).class_id; class_id != 0)
        return classes_.colour(class_id);
    return vertex.has_colour ? NoCategoryColour(vertex.colour) : kNoSceneColour;
}

Image<VertexLabel> LabelMapper::PredictLabels(const Eigen::Isometry3d& T_world_camera,
                                              float farthest_m, const BlockMap& map) {
    Image<InstanceId> voted;
    instance_view_.Predict(map, camera_, T_world_camera, kNear_m,
                           std::max(2 * kNear_m, std::min(farthest_m, max_depth_m_)), voted);
    Image<VertexLabel> labels(voted.width(), voted.height());
    std::transform(voted.data(), voted.data() + voted.size(), labels.data(),
                   [this](InstanceId id) { return LabelOfInstance(id); });
    return labels;
}

// After LoadState or MapMoved every block may have votes.
void LabelMapper::KnowBlocks(const BlockMap& map) {
    votes_.resize(static_cast<std::size_t>(map.size()),
                  std::exchange(loaded_, false) ? Votes::kNew : Votes::kNone);
}

std::vector<BlockId> LabelMapper::TakeRelabelled(const BlockMap& map) {
    KnowBlocks(map);
    std::vector<std::uint8_t> changed(static_cast<std::size_t>(instances_.last()) + 1, 0);
    shown_.resize(changed.size());
    bool any_changed = false;
    for (std::size_t id = 1; id < changed.size(); ++id) {
        const VertexLabel label = LabelOfInstance(static_cast<InstanceId>(id));
        changed[id] = label != shown_[id];
        any_changed |= changed[id] != 0;
        shown_[id] = label;
    }
    const auto holds_changed = [&](const VoxelLabel& voxel) {
        return changed[voxel.instance] != 0;
    };
    std::vector<BlockId> relabelled;
    for (std::size_t i = 0; i < votes_.size(); ++i) {
        if (votes_[i] == Votes::kNone) continue;
        const VoxelLabel* voxels = map.label(static_cast<BlockId>(i));
        if (votes_[i] == Votes::kNew ||
            (any_changed && std::any_of(voxels, voxels + kBlockVoxels, holds_changed)))
            relabelled.push_back(static_cast<BlockId>(i));
        votes_[i] = Votes::kTold;
    }
    return relabelled;
}

TriangleMesh LabelMapper::LabelledVertices(
    const BlockMap& map, const std::vector<std::unique_ptr<const BlockMesh>>& meshes) const {
    TriangleMesh labelled;
    for (std::size_t i = 0; i < std::min(votes_.size(), meshes.size()); ++i) {
        if (votes_[i] == Votes::kNone || !meshes[i]) continue;
        const KnownBlock known{meshes[i]->coord, map.Find(meshes[i]->coord)};
        for (const BlockMesh::Vertex& vertex : meshes[i]->vertices) {
            const Eigen::Vector3f p_world =
                VertexPosition(*meshes[i], vertex, map.config().voxel_size_m);
            const VertexLabel label = LabelOf(LabelNear(map, known, p_world.cast<double>()));
            if (label.instance == 0) continue;
            labelled.vertices.push_back(p_world);
            labelled.labels.push_back(label);
        }
    }
    for (const auto& [coord, vertices] : away_)
        for (const LabelledVertex& vertex : vertices) {
            const VertexLabel label = LabelOfInstance(vertex.voted_for);
            if (label.instance == 0) continue;
            labelled.vertices.push_back(vertex.p_world);
            labelled.labels.push_back(label);
        }
    return labelled;
}

void LabelMapper::Leave(const BlockMap& map, std::span<const BlockId> blocks,
                        const std::vector<std::unique_ptr<const BlockMesh>>& meshes) {
    KnowBlocks(map);
    for (const BlockId id : blocks) {
        const auto at = static_cast<std::size_t>(id);
        if (std::exchange(votes_[at], Votes::kNone) == Votes::kNone) continue;
        if (at >= meshes.size() || !meshes[at] || !(meshes[at]->coord == map.coord(id))) continue;
        std::vector<LabelledVertex> vertices;
        for (const BlockMesh::Vertex& vertex : meshes[at]->vertices) {
            const Eigen::Vector3f p_world =
                VertexPosition(*meshes[at], vertex, map.config().voxel_size_m);
            const VoxelLabel voxel = LabelNear(map, p_world.cast<double>());
            if (ClassOf(voxel) != 0 && voxel.instance != 0)
                vertices.push_back({p_world, voxel.instance});
        }
        if (!vertices.empty()) away_[map.coord(id)] = std::move(vertices);
    }
}

void LabelMapper::Return(const BlockMap& map, std::span<const BlockId> blocks) {
    KnowBlocks(map);
    for (const BlockId id : blocks) {
        const VoxelLabel* voxels = map.label(id);
        const bool voted = std::any_of(voxels, voxels + kBlockVoxels,
                                       [](const VoxelLabel& v) { return v.count[0] > 0; });
        votes_[static_cast<std::size_t>(id)] = voted ? Votes::kNew : Votes::kNone;
    }
}

void LabelMapper::Meshed(const BlockMap& map, std::span<const BlockId> blocks) {
    if (away_.empty()) return;
    for (const BlockId id : blocks) away_.erase(map.coord(id));
}

std::vector<MapObject> LabelMapper::Objects(double voxel_size_m, TriangleMesh& labelled) const {
    std::vector<MapObject> objects;
    std::map<int, double> least_m2;  // by public number
    for (const InstanceId id : instances_.ids()) {
        if (instances_.Resolve(id) != id || !instances_.stands(id)) continue;
        MapObject object;
        object.id = instances_.record(id).public_id;
        object.class_id = instances_.ClassOf(id);
        object.class_name = classes_.name(object.class_id);
        object.colour = classes_.colour(object.class_id);
        object.probability = instances_.Probability(id);
        object.observations = instances_.record(id).observations;
        object.embedding = instances_.Embedding(id);
        objects.push_back(std::move(object));
        least_m2[objects.back().id] =
            std::max(kLeastArea_m2, kLeastSeenShare * instances_.SeenArea_m2(id));
    }
    MeasureObjects(labelled, objects);
    std::set<int> remains;
    for (const MapObject& o : objects)
        if (static_cast<double>(o.vertices) * voxel_size_m * voxel_size_m < least_m2[o.id])
            remains.insert(o.id);
    std::erase_if(objects, [&](const MapObject& o) { return remains.contains(o.id); });
    for (VertexLabel& label : labelled.labels)
        if (remains.contains(label.instance)) label = {};
    std::ranges::sort(objects, {}, &MapObject::id);
    return objects;
}

}  // namespace tessera
