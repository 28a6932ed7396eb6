// Labels a map. Takes detections with the depth and pose of their frame, adds their votes to the
// voxels, keeps the instances apart, and labels the final mesh.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapping/block_mesh.h"
#include "semantics/instance_view.h"
#include "semantics/instances.h"
#include "semantics/label_votes.h"
#include "semantics/map_object.h"

namespace tessera {

// The map's owner thread only.
class LabelMapper {
  public:
    // Ignores depths beyond `max_depth_m`. These are not fused, and their blocks need not be in
    // memory.
    LabelMapper(const LabelConfig& config, LabelClasses classes, const PinholeCamera& camera,
                float max_depth_m = std::numeric_limits<float>::max());

    // From the next Label on. `settings.prediction` replaces that of the configuration. Objects of
    // ignored classes stay, although they are no longer detected.
    void Apply(const LabelSettings& settings) {
        instance_view_.Select(settings.prediction);
        ignored_ = settings.ignored;
    }
    // The same for the ignored classes alone.
    void Ignore(const ClassSet& classes) { ignored_ = classes; }

    // `detections`: as returned by FilterWanted, for the frame with this depth and pose. The frame
    // need not be the last one fused. The map must have labels.
    VoteCount Label(std::span<const Detection> detections, const DepthImage& depth_m,
                    const Eigen::Isometry3d& T_world_camera, BlockMap& map);

    // Returns the object that each pixel of a camera at this pose sees, without those that are not
    // confirmed, no farther than this (metres along z).
    Image<VertexLabel> PredictLabels(const Eigen::Isometry3d& T_world_camera, float farthest_m,
                                     const BlockMap& map);

    // Sets the label of each vertex from its voxel: the class and the public number of the voxel's
    // instance. Vertices of unconfirmed instances get no label.
    void LabelVertices(const BlockMap& map, TriangleMesh& mesh) const;

    // The label of one vertex of a block mesh, and the colour of its class. A vertex without a
    // class gets a grey of the scene's brightness. Thread-safe while no other thread labels.
    VertexLabel LabelOf(const BlockMap& map, const BlockMesh& owner,
                        const BlockMesh::Vertex& vertex) const;
    Rgb8 ColourOf(const BlockMap& map, const BlockMesh& owner,
                  const BlockMesh::Vertex& vertex) const;

    // Returns the blocks whose vertices may be labelled differently than at the last call, in
    // increasing order: those that got votes since, and those that hold an instance that was
    // confirmed, joined or withheld or changed its class since.
    std::vector<BlockId> TakeRelabelled(const BlockMap& map);

    // Returns the labelled vertices of all blocks that ever got votes, including those paged out,
    // without triangles. Objects needs them to measure an unfinished map. `meshes`: by block id, as
    // Mesher keeps them.
    TriangleMesh LabelledVertices(
        const BlockMap& map, const std::vector<std::unique_ptr<const BlockMesh>>& meshes) const;

    // Call before blocks are paged out; keeps what LabelledVertices returns for them. `meshes`: as
    // above.
    void Leave(const BlockMap& map, std::span<const BlockId> blocks,
               const std::vector<std::unique_ptr<const BlockMesh>>& meshes);
    // Call when blocks were paged in again, perhaps under other ids, and when they were meshed.
    void Return(const BlockMap& map, std::span<const BlockId> blocks);
    void Meshed(const BlockMap& map, std::span<const BlockId> blocks);

    // Returns the confirmed objects that the labelled mesh shows, sorted by number. Objects with
    // less than 15 square centimetres of surface, or less than a tenth of what their detections saw
    // on average, are discarded and their labels cleared.
    std::vector<MapObject> Objects(double voxel_size_m, TriangleMesh& labelled) const;

    // Why `config.prediction` is not used; usually empty. Known after the first Label.
    const std::string& warning() const { return instance_view_.warning(); }
    const LabelClasses& classes() const { return classes_; }
    const Instances& instances() const { return instances_; }
    // For a mapper that labelled a corrected map with the same detections: its objects keep their
    // previous numbers.
    void KeepNumbersOf(const LabelMapper& before) { instances_.KeepNumbersOf(before.instances_); }
    // Forgets everything, for a new map.
    void Reset();
    // Keeps the objects, for a map in which the same labelled voxels lie elsewhere.
    void MapMoved();
    // Saves and restores the class names and the instances. LoadState returns false if the classes
    // differ.
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // Reads the class names, with which a state begins. Nothing if it is damaged.
    static std::optional<std::vector<std::string>> LoadClassNames(StateReader& state);

  private:
    static constexpr float kNear_m = 0.1f;  // of predicted views

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
    InstanceView instance_view_;
    ClassSet ignored_;
    Image<InstanceId> predicted_;
    LabelImage image_;
    DepthImage near_m_;  // the frame's depth without what is too far
    Instances instances_;
    enum class Votes : std::uint8_t { kNone, kTold, kNew };
    std::vector<Votes> votes_;        // by block id
    std::vector<VertexLabel> shown_;  // by InstanceId, as of the last TakeRelabelled
    // Vertices of blocks that were paged out and not meshed since.
    std::map<BlockCoord, std::vector<LabelledVertex>> away_;
    bool loaded_ = false;  // true after LoadState or MapMoved until the blocks are known
};

}  // namespace tessera
