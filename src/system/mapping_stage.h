// The second half of the pipeline: fuses a frame, meshes what changed, and feeds the tracker's copy
// of the map and the viewer. The only owner and writer of the map.
#pragma once

#include "mapping/map_delta.h"
#include "mapping/mesher.h"
#include "optimize/block_mover.h"
#include "render/geometry_builder.h"
#include "scan/block_codec.h"
#include "semantics/label_mapper.h"
#include "system/tracking_stage.h"

namespace tessera {

struct MapStatistics {
    std::int64_t blocks = 0;
    std::size_t bytes = 0;
    double bytes_per_voxel = 0;
};

inline MapStatistics StatisticsOf(const BlockMap& map) {
    return {map.count(), map.bytes(), map.bytes_per_voxel()};
}

// Remeshed blocks, which replace the viewer's blocks with the same ids.
struct MeshUpdate {
    double voxel_size_m = 0;
    bool clear = false;  // first discard all earlier blocks
    // With these blocks, all that the map had when the earlier ones were discarded have been sent.
    bool whole = true;
    bool last = false;  // the run has ended, and with these blocks all of its final mesh was sent
    std::vector<GeometryBlock> blocks;
};

// Owner thread only.
class MappingStage {
  public:
    // `device` outlives the stage. Null: everything runs on the CPU.
    MappingStage(const PipelineConfig& config, const MeshConfig& meshing,
                 const PinholeCamera& camera, Backend* device = nullptr);

    // Fuses the frame into the map if `to_fuse` is set, and fills in its fusion report.
    void Fuse(TrackedFrame& tracked);

    // The map holds labels from now on.
    void EnableLabels(const LabelConfig& config, LabelClasses classes);
    // With labels only: votes detections into the map, using the pose and depth of the frame in
    // which they were detected.
    VoteCount Label(std::span<const Detection> detections, const DepthImage& depth_m,
                    const Eigen::Isometry3d& T_world_camera);
    // With labels only: for the calls of Label from now on.
    void Apply(const LabelSettings& settings) { labels_->Apply(settings); }
    // With labels only: the object that each pixel of a camera at this pose sees.
    Image<VertexLabel> PredictLabels(const Eigen::Isometry3d& T_world_camera);
    // Warning about how labels are predicted, for the user; usually empty.
    std::string labels_warning() const { return labels_ ? labels_->warning() : ""; }
    // With labels, after TakeMesh: the objects in its mesh.
    const std::vector<MapObject>& objects() const { return objects_; }
    // With labels: the objects known and meshed so far; else none. Takes a few milliseconds.
    std::vector<MapObject> MeasureObjects() const;
    // Changes whenever labels may have changed. 0 before the first labels, and always without
    // labels.
    std::uint64_t labels_revision() const { return labels_revision_; }

    bool has_labels() const { return labels_ != nullptr; }
    // With labels only: label state that is not stored in voxels. LoadLabels returns false if the
    // state is invalid or has other classes.
    void SaveLabels(StateWriter& state) const { labels_->SaveState(state); }
    bool LoadLabels(StateReader& state) { return labels_->LoadState(state); }

    // Record changes for CollectDelta from now on. Call before the first frame.
    void KeepDeltas() { keep_deltas_ = true; }
    // Collects the changes since the last call, for a copy of the map's field. Call after each
    // Fuse, Release and Return.
    void CollectDelta(MapDelta& delta);
    bool has_delta() const { return !changed_.empty() || !block_changes_.empty(); }

    // Removes blocks from the map, and puts stored blocks back unchanged. Return writes their new
    // ids to `ids`.
    void Release(std::span<const BlockId> blocks);
    void Return(const BlockCopies& blocks, std::vector<BlockId>& ids);

    // Remeshes at most `budget_blocks` changed blocks into `update`. Returns how many still wait.
    int UpdateMesh(int budget_blocks, MeshUpdate& update);
    // Discards the meshes made so far: calls of UpdateMesh make all of them again.
    void MeshAgain();

    // The whole mesh up to the last fused frame, without small pieces.
    TriangleMesh Mesh() const;
    // The final mesh. Unless the map is to be kept, releases it before it assembles the mesh, so
    // that both need not fit into memory.
    TriangleMesh TakeMesh(bool keep_map = false);
    bool has_map() const { return map_ != nullptr; }
    // Warning about the meshes made so far, for the user; usually empty.
    std::string mesh_warning() const;
    // Like TakeMesh, if part of the map is only in the scan file. The file must hold the whole map.
    // On error sets `status` and returns an empty mesh.
    TriangleMesh TakeStoredMesh(const std::string& scan_path, Status& status);

    // The surface as seen by a camera at this pose, at 1/`step` of its resolution.
    void Predict(const Eigen::Isometry3d& T_world_camera, int step, PredictedView& view) const;

    // Replaces the map by one fused elsewhere from the same frames. `labels`: of the new map, if
    // this one has labels; null if the new one was begun before that, or if its labels were moved
    // there from this one. Whoever follows the map by deltas first needs a copy of the new field.
    void Replace(std::unique_ptr<BlockMap> map, std::unique_ptr<LabelMapper> labels);

    // Only if Replace follows for certain: there are then never two maps.
    void FreeMap() {
        map_.reset();
        Place(std::make_unique<BlockMap>(config_.map));
    }

    // Replaces the map by one that was moved, by T_new_old at the latest frames, from a copy of
    // this map at that revision. What has changed since follows: a part of it at once, the latest
    // new blocks first, the rest with calls of Follow while `following`. What is fused meanwhile
    // stays; its unknown voxels are filled in. Labels, if this map has got any since, are dropped.
    void ReplaceMoved(std::unique_ptr<BlockMap> map, const Eigen::Isometry3d& T_new_old,
                      std::uint32_t moved_at);
    bool following() const { return following_.has_value(); }
    void Follow();

    // Call before the first frame to continue with a map made of `fused_frames` frames.
    void Resume(std::unique_ptr<BlockMap> map, std::uint32_t fused_frames);
    std::uint32_t fused_frames() const { return integrator_->revision(); }

    // Clears the map.
    void Reset();

    // With a device: first downloads the changed voxels.
    const BlockMap& map() const;
    // Does not download: blocks and ids are valid, but current voxels may be only on the device.
    const BlockMap& blocks() const { return *map_; }

  private:
    // Meshes on the device if there is one with enough memory; else downloads the voxels and meshes
    // on the CPU.
    int UpdateMesher(Mesher& mesher, int budget_blocks) const;
    void Place(std::unique_ptr<BlockMap> map);
    void BeginAnew();
    void AddChanges(std::span<const BlockId> added, std::span<const BlockId> changed);

    PipelineConfig config_;
    PinholeCamera camera_;
    std::unique_ptr<BlockMap> map_;  // null after TakeMesh
    BackendOf backend_;
    std::unique_ptr<Integrator> integrator_;
    std::unique_ptr<BlockMesher> block_mesher_;
    mutable bool device_refused_ = false;  // the device had no memory to mesh
    Mesher mesher_;
    GeometryBuilder geometry_;
    std::unique_ptr<LabelMapper> labels_;  // null without labels
    std::vector<MapObject> objects_;
    std::uint64_t labels_revision_ = 0;
    bool keep_deltas_ = false;
    std::vector<BlockChange> block_changes_;  // since the last CollectDelta
    // Blocks whose field changed since the last CollectDelta.
    std::vector<BlockId> changed_;
    struct Following {
        std::unique_ptr<BlockMap> from;  // the map before
        BlockMover mover;
        std::uint32_t replaced_at = 0;     // revision
        std::size_t added = 0, moved = 0;  // of the mover's, in the map and told
    };
    std::optional<Following> following_;
    bool mesh_cleared_ = false;  // since the last UpdateMesh
    int never_meshed_ = 0;       // blocks, of those that the map had when it was cleared
};

}  // namespace tessera
