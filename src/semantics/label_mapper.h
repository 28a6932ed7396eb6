// Labels of a map: takes detections with the pose and depth of their frame, votes them into the
// voxels, keeps the instances apart, and labels the mesh at the end.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "mapping/block_mesh.h"
#include "mapping/ray_caster.h"
#include "semantics/instances.h"
#include "semantics/label_votes.h"
#include "semantics/map_object.h"

namespace tessera {

// The map's owner thread only.
class LabelMapper {
  public:
    // What is farther than `max_depth_m` is not looked at: it is not fused either, and need not be
    // in memory.
    LabelMapper(const LabelConfig& config, LabelClasses classes, const PinholeCamera& camera,
                float max_depth_m = std::numeric_limits<float>::max());

    // `detections` as KeepWanted leaves them, of the frame with this depth and pose; the frame need
    // not be the last one fused. The map has labels.
    VoteCount Label(std::span<const Detection> detections, const DepthImage& depth_m,
                    const Eigen::Isometry3d& T_world_camera, BlockMap& map);

    // Gives each vertex the label of the voxel it lies at: the class of its confirmed instance,
    // else its own; nothing where the instance is not confirmed. VertexLabel::instance is the
    // public number.
    void LabelVertices(const BlockMap& map, TriangleMesh& mesh) const;

    // The same of one vertex of a block's mesh, and the colour of that class; without one a grey as
    // bright as the scene. Thread-safe while nobody labels.
    VertexLabel LabelOf(const BlockMap& map, const BlockMesh& owner,
                        const BlockMesh::Vertex& vertex) const;
    Rgb8 ColourOf(const BlockMap& map, const BlockMesh& owner,
                  const BlockMesh::Vertex& vertex) const;

    // The blocks with voxels whose label may show differently than at the last call: voted into
    // since, or of an instance that has since been confirmed, joined, withheld or has changed its
    // class. Increasing.
    std::vector<BlockId> TakeRelabelled(const BlockMap& map);

    // The vertices with a label of blocks that were ever voted into, those that left memory
    // included, and no triangles: what Objects needs for a look at an unfinished map. `meshes` by
    // block id, as Mesher keeps them.
    TriangleMesh LabelledVertices(
        const BlockMap& map, const std::vector<std::unique_ptr<const BlockMesh>>& meshes) const;

    // Blocks are about to leave memory: what LabelledVertices gives of them is kept. `meshes`
    // likewise.
    void Leave(const BlockMap& map, std::span<const BlockId> blocks,
               const std::vector<std::unique_ptr<const BlockMesh>>& meshes);
    // They came back, perhaps under other ids; and they were meshed again.
    void Return(const BlockMap& map, std::span<const BlockId> blocks);
    void Meshed(const BlockMap& map, std::span<const BlockId> blocks);

    // The confirmed objects that the labelled mesh shows, by number. Remains of less than 15 square
    // centimetres, or of a tenth of what its detections saw of it, are none, and lose their label.
    std::vector<MapObject> Objects(double voxel_size_m, TriangleMesh& labelled) const;

    const LabelClasses& classes() const { return classes_; }
    const Instances& instances() const { return instances_; }
    // For one that labelled a corrected map with the same detections: its objects have the numbers
    // that they had.
    void KeepNumbersOf(const LabelMapper& before) { instances_.KeepNumbersOf(before.instances_); }
    // Everything forgotten: a new map.
    void Reset();
    // The classes by name, and the instances. LoadState is false if the classes are others.
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);

  private:
    struct LabelledVertex {
        Eigen::Vector3f p_world;
        InstanceId voted_for = 0;
    };

    const DepthImage& WithinReach(const DepthImage& depth_m, float farthest_m);
    void KnowBlocks(const BlockMap& map);
    void PredictInstances(const Eigen::Isometry3d& T_world_camera, float farthest_m,
                          const BlockMap& map);
    std::map<InstanceId, VisibleObject> Visible() const;
    std::vector<ObservedObject> Observe(std::span<const Detection> detections,
                                        const DepthImage& depth_m,
                                        const Eigen::Isometry3d& T_world_camera) const;
    VertexLabel LabelOf(const VoxelLabel& voxel) const;
    VertexLabel LabelOfInstance(InstanceId id) const;

    LabelConfig config_;
    LabelClasses classes_;
    PinholeCamera camera_;
    float max_depth_m_;
    int step_px_;  // of the sampled views
    RayCaster ray_caster_;
    PredictedView view_;
    Image<InstanceId> predicted_;
    LabelImage image_;
    DepthImage near_m_;  // the frame's depth, where part of it is too far
    Instances instances_;
    enum class Votes : std::uint8_t { kNone, kTold, kNew };
    std::vector<Votes> votes_;        // by block id
    std::vector<VertexLabel> shown_;  // by InstanceId, as told by the last TakeRelabelled
    // Of blocks that left and were not meshed since.
    std::map<BlockCoord, std::vector<LabelledVertex>> away_;
    bool loaded_ = false;  // by LoadState, and nothing known of the blocks yet
};

}  // namespace tessera
