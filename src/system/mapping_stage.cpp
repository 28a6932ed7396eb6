#include "system/mapping_stage.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/check.h"
#include "core/notices.h"
#include "render/vertex_weight.h"
#include "scan/stored_mesh.h"

namespace tessera {

MappingStage::MappingStage(const PipelineConfig& config, const MeshConfig& meshing,
                           const PinholeCamera& camera, Backend* device)
    : config_(config),
      camera_(camera),
      map_(std::make_unique<BlockMap>(config.map)),
      backend_(device),
      integrator_(backend_->MakeIntegrator(config.fusion, camera)),
      block_mesher_(backend_->MakeBlockMesher()),
      mesher_(meshing) {}

void MappingStage::Fuse(TrackedFrame& tracked) {
    if (!tracked.to_fuse) return;
    FrameReport& report = tracked.report;
    report.fusion = integrator_->Integrate(tracked.prepared, tracked.view, *map_);
    report.fused = true;
    AddChanges(integrator_->added_blocks(), integrator_->changed_blocks());
    if (report.fusion.refused_blocks > 0)
        AddNote(
            fmt::format("{} of {} new blocks refused: {}", report.fusion.refused_blocks,
                        report.fusion.refused_blocks + report.fusion.new_blocks,
                        report.fusion.map_full ? integrator_->limit() : "mapping.max_new_blocks"),
            report.warning);
}

const BlockMap& MappingStage::map() const {
    integrator_->Bring(*map_);
    return *map_;
}

void MappingStage::EnableLabels(const LabelConfig& config, LabelClasses classes) {
    if (!map_->has_labels()) map_->EnableLabels();  // that of a scan may have them
    labels_ = std::make_unique<LabelMapper>(config, std::move(classes), camera_,
                                            static_cast<float>(config_.frame.max_depth_m));
}

VoteCount MappingStage::Label(std::span<const Detection> detections, const DepthImage& depth_m,
                              const Eigen::Isometry3d& T_world_camera) {
    ++labels_revision_;
    integrator_->Bring(*map_);
    return labels_->Label(detections, depth_m, T_world_camera, *map_);
}

Image<VertexLabel> MappingStage::PredictLabels(const Eigen::Isometry3d& T_world_camera) {
    integrator_->Bring(*map_);
    return labels_->PredictLabels(T_world_camera, static_cast<float>(config_.frame.max_depth_m),
                                  *map_);
}

void MappingStage::CollectDelta(MapDelta& delta) {
    std::ranges::sort(changed_);
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    std::erase_if(changed_, [this](BlockId id) { return map_->IsFree(id); });
    tessera::CollectDelta(map(), config_.trackers.layers(), block_changes_, changed_,
                          integrator_->revision(), delta);
    block_changes_.clear();
    changed_.clear();
}

// For CollectDelta: new blocks, and blocks whose field has changed, the new ones included.
void MappingStage::AddChanges(std::span<const BlockId> added, std::span<const BlockId> changed) {
    if (!keep_deltas_) return;
    for (const BlockId id : added) block_changes_.push_back({id, false, map_->coord(id)});
    changed_.insert(changed_.end(), changed.begin(), changed.end());
}

void MappingStage::Release(std::span<const BlockId> blocks) {
    if (labels_) labels_->Leave(*map_, blocks, mesher_.block_meshes());
    for (const BlockId id : blocks) {
        if (keep_deltas_) block_changes_.push_back({id, true, map_->coord(id)});
        map_->Release(id);
    }
}

void MappingStage::Return(const BlockCopies& blocks, std::vector<BlockId>& ids) {
    ids.clear();
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        TESSERA_CHECK(map_->Find(blocks.coords[i]) == kUnknownBlock,
                      "a block was returned that is already in the map");
        const BlockId id = map_->Allocate(blocks.coords[i], blocks.numbers[i]);
        TESSERA_CHECK(id != kUnknownBlock, "no room for a block that was in the map before");
        blocks.Put(i, *map_, id);
        map_->MarkChanged(id, integrator_->revision());
        ids.push_back(id);
    }
    AddChanges(ids, ids);
    if (labels_) labels_->Return(*map_, ids);
}

int MappingStage::UpdateMesher(Mesher& mesher, int budget_blocks) const {
    const int waiting = mesher.Update(*map_, budget_blocks, *block_mesher_);
    if (waiting == 0 || budget_blocks <= 0 || !mesher.updated().empty()) return waiting;
    device_refused_ = true;
    return mesher.Update(map(), budget_blocks);
}

std::string MappingStage::mesh_warning() const {
    return device_refused_ ? "meshed on the CPU: " + integrator_->limit() : "";
}

int MappingStage::UpdateMesh(int budget_blocks, MeshUpdate& update) {
    integrator_->Bring(*map_);  // the vertex marks are computed from voxels
    const int waiting = UpdateMesher(mesher_, budget_blocks);
    update.voxel_size_m = map_->config().voxel_size_m;
    update.clear = std::exchange(mesh_cleared_, false);
    // The oldest are meshed first.
    never_meshed_ = update.clear
                        ? waiting
                        : std::max(0, never_meshed_ - static_cast<int>(mesher_.updated().size()));
    update.whole = never_meshed_ == 0;
    if (labels_) labels_->Meshed(*map_, mesher_.updated());
    if (labels_) geometry_.MarkAgain(labels_->TakeRelabelled(*map_));
    const auto mark = [this](const BlockMesh& owner, const BlockMesh::Vertex& vertex) {
        return VertexMark{labels_ ? labels_->ColourOf(*map_, owner, vertex) : Rgb8{},
                          WeightStep(VertexWeight(*map_, owner, vertex))};
    };
    const std::span<GeometryBlock> blocks = geometry_.Build(*map_, mesher_, mark);
    update.blocks.assign(std::make_move_iterator(blocks.begin()),
                         std::make_move_iterator(blocks.end()));
    return waiting;
}

void MappingStage::MeshAgain() {
    mesher_.Clear();
    geometry_.Clear();
    mesh_cleared_ = true;
}

std::vector<MapObject> MappingStage::MeasureObjects() const {
    if (!labels_) return {};
    TriangleMesh labelled = labels_->LabelledVertices(*map_, mesher_.block_meshes());
    return labels_->Objects(map_->config().voxel_size_m, labelled);
}

TriangleMesh MappingStage::Mesh() const {
    Mesher mesher(mesher_.config());
    UpdateMesher(mesher, Mesher::kNoLimit);
    TriangleMesh mesh = mesher.Assemble();
    if (labels_) labels_->LabelVertices(*map_, mesh);
    return mesh;
}

TriangleMesh MappingStage::TakeMesh(bool keep_map) {
    UpdateMesher(mesher_, Mesher::kNoLimit);
    if (!labels_ && !keep_map) map_.reset();
    TriangleMesh mesh = mesher_.Assemble();
    if (!keep_map) mesher_.Clear();
    if (labels_) {
        labels_->LabelVertices(*map_, mesh);
        objects_ = labels_->Objects(map_->config().voxel_size_m, mesh);
        if (!keep_map) map_.reset();
    }
    return mesh;
}

TriangleMesh MappingStage::TakeStoredMesh(const std::string& scan_path, Status& status) {
    map_.reset();
    mesher_.Clear();
    StoredVertexLabel label;
    if (labels_)
        label = [this](const BlockMap& map, const BlockMesh& owner,
                       const BlockMesh::Vertex& vertex) {
            return labels_->LabelOf(map, owner, vertex);
        };
    Result<TriangleMesh> mesh = MeshOfStoredMap(scan_path, config_.map, mesher_.config(), label);
    if (!mesh.ok()) {
        status = mesh.status();
        return {};
    }
    if (labels_) objects_ = labels_->Objects(config_.map.voxel_size_m, mesh.value());
    return std::move(mesh.value());
}

void MappingStage::Predict(const Eigen::Isometry3d& T_world_camera, int step,
                           PredictedView& view) const {
    constexpr float kNear_m = 0.1f;
    const float far_m = 1.2f * static_cast<float>(config_.frame.max_depth_m);
    backend_->views().Predict(*map_, camera_.Every(step), T_world_camera, kNear_m, far_m, view);
}

void MappingStage::Replace(std::unique_ptr<BlockMap> map, std::unique_ptr<LabelMapper> labels) {
    Place(std::move(map));
    if (labels_ && !labels && map_->has_labels()) {
        labels_->MapMoved();
    } else if (labels_ && !labels) {
        map_->EnableLabels();
        labels_->Reset();
    } else {
        if (labels && labels_) labels->KeepNumbersOf(*labels_);
        labels_ = std::move(labels);
    }
    integrator_->MarkAllChanged(*map_);
}

void MappingStage::Place(std::unique_ptr<BlockMap> map) {
    map_ = std::move(map);
    BeginAnew();
}

// What refers to an earlier map is forgotten.
void MappingStage::BeginAnew() {
    following_.reset();
    if (labels_) ++labels_revision_;
    block_changes_.clear();
    changed_.clear();
    MeshAgain();
}

void MappingStage::Resume(std::unique_ptr<BlockMap> map, std::uint32_t fused_frames) {
    Place(std::move(map));
    integrator_->SetRevision(fused_frames);
}

void MappingStage::Reset() {
    map_->Clear();
    if (labels_) labels_->Reset();
    BeginAnew();
}

}  // namespace tessera
