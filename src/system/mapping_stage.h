// The second half of a frame's life: fuse it, mesh what changed, tell the tracker's copy and the
// viewer. The one owner and writer of the map.
#pragma once

#include "mapping/map_delta.h"
#include "mapping/mesher.h"
#include "render/geometry_builder.h"
#include "scan/block_codec.h"
#include "semantics/label_mapper.h"
#include "system/tracking_stage.h"

namespace tessera {

// Blocks of the map's mesh that were made anew, to replace what the viewer has under the same ids.
struct MeshUpdate {
    double voxel_size_m = 0;
    bool clear = false;  // first forget all that came before
    std::vector<GeometryBlock> blocks;
};

// Owner thread only.
class MappingStage {
  public:
    // `device` outlives the stage; null: all on the processor.
    MappingStage(const PipelineConfig& config, const MeshConfig& meshing,
                 const PinholeCamera& camera, Device* device = nullptr);

    // Puts the frame into the map, if it is to be, and reports that in it.
    void Fuse(TrackedFrame& tracked);

    // The map holds labels from here on; before the first frame.
    void EnableLabels(const LabelConfig& config, LabelClasses classes);
    // Only with labels: votes detections into the map, with the pose and depth of the frame that
    // was detected.
    VoteCount Label(std::span<const Detection> detections, const DepthImage& depth_m,
                    const Eigen::Isometry3d& T_world_camera);
    // With labels: the objects of the mesh that TakeMesh gave, once it did.
    const std::vector<MapObject>& objects() const { return objects_; }
    // With labels: the objects as far as they are known and meshed now; else none. Costs some
    // milliseconds.
    std::vector<MapObject> MeasureObjects() const;
    // Another number whenever labels may have changed; 0 before the first, and always without
    // labels.
    std::uint64_t labels_revision() const { return labels_revision_; }

    bool has_labels() const { return labels_ != nullptr; }
    // Only with labels: what is known of objects besides the voxels. False: of other classes, or no
    // such state.
    void SaveLabels(StateWriter& state) const { labels_->SaveState(state); }
    bool LoadLabels(StateReader& state) { return labels_->LoadState(state); }

    // Deltas are asked for from here on; before the first frame.
    void KeepDeltas() { keep_deltas_ = true; }
    // What changed since the last one, for a copy of the map's field; to be called after each Fuse,
    // Release and Return.
    void CollectDelta(MapDelta& delta);
    bool has_delta() const { return !changed_.empty() || !block_changes_.empty(); }

    // Blocks leave memory, and come back as they were under the ids that `ids` then has.
    void Release(std::span<const BlockId> blocks);
    void Return(const BlockCopies& blocks, std::vector<BlockId>& ids);

    // All of the map, for a copy that is empty.
    void CollectWhole(MapDelta& delta);

    // Meshes again at most `budget_blocks` of what has changed; returns how many wait. `update`
    // takes them.
    int UpdateMesh(int budget_blocks, MeshUpdate& update);

    // The whole mesh up to the last frame fused, small pieces left out.
    TriangleMesh Mesh() const;
    // The same at the end: the map goes before the mesh is put together, so that both need not fit
    // into memory.
    TriangleMesh TakeMesh();
    // What a person should know of the meshes made since, in words; mostly empty.
    std::string mesh_warning() const;
    // The same where part of the map is in the scan file only, and all of it there. An error goes
    // to `status`, the mesh is then empty.
    TriangleMesh TakeStoredMesh(const std::string& scan_path, Status& status);

    // The surface as the camera sees it from where it was, at 1/`step` of its resolution.
    void Predict(const Eigen::Isometry3d& T_world_camera, int step, PredictedView& view) const;

    // In place of the map so far: one that was fused from the same frames elsewhere. `labels`: of
    // that map, if this one has any. Whoever follows it by deltas needs a copy of the new field
    // first.
    void Replace(std::unique_ptr<BlockMap> map, std::unique_ptr<LabelMapper> labels);

    // Before the first frame: goes on with a map that so many fused frames made.
    void Resume(std::unique_ptr<BlockMap> map, std::uint32_t fused_frames);
    std::uint32_t fused_frames() const { return integrator_->revision(); }

    // An empty map.
    void Reset();

    // With a device it is asked for the voxels that changed.
    const BlockMap& map() const;
    // The same without: the blocks and their ids hold, their voxels may be on the device only.
    const BlockMap& blocks() const { return *map_; }

  private:
    // On the device where there is one with room for it; else the voxels are brought here.
    int UpdateMesher(Mesher& mesher, int budget_blocks) const;
    void Place(std::unique_ptr<BlockMap> map);
    void ForgetDelta();

    PipelineConfig config_;
    PinholeCamera camera_;
    std::unique_ptr<BlockMap> map_;  // null once the mesh was taken
    std::unique_ptr<Integrator> integrator_;
    ViewPredictor* device_views_;                 // null: views are cast here
    std::unique_ptr<BlockMesher> device_mesher_;  // null: blocks are meshed here
    mutable bool device_refused_ = false;         // to mesh: no room
    Mesher mesher_;
    GeometryBuilder geometry_;
    std::unique_ptr<LabelMapper> labels_;  // null without labels
    std::vector<MapObject> objects_;
    std::uint64_t labels_revision_ = 0;
    bool keep_deltas_ = false;
    std::vector<BlockChange> block_changes_;  // since the last CollectDelta
    std::vector<BlockId> changed_;            // the same: their field
    bool mesh_cleared_ = false;               // since the last UpdateMesh
};

}  // namespace tessera
