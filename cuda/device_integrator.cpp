#include "cuda/device_integrator.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/check.h"
#include "cuda/device_fusion.h"

namespace tessera::TESSERA_DEVICE {

DeviceIntegrator::DeviceIntegrator(DevicePipeline& device, const Config& config,
                                   const PinholeCamera& camera)
    : Integrator(config, camera), device_(device) {}

std::string DeviceIntegrator::limit() const {
    return fmt::format("the GPU memory limit of {} MB is reached (mapping.device_memory_mb)",
                       device_.limit_bytes() >> 20);
}

void DeviceIntegrator::Allocate(const PreparedFrame& frame, const View& view, BlockMap& map,
                                Report& report) {
    DeviceMap* mirror = device_.MirrorOf(map);
    uploaded_ = mirror != nullptr && device_.frame_.Upload(frame);
    report.map_full = !uploaded_;
    if (!uploaded_) {
        report.refused_blocks = 1;  // the true number is unknown
        return;
    }
    if (brought_map_ != map.identity()) {
        brought_map_ = map.identity();
        brought_revision_ = revision_ - 1;
    }
    BandWalk walk = MakeBandWalk(frame, camera_, view.T_world_camera, map.config());
    walk.depth_m = device_.frame_.depth_m();
    const DeviceMap::Growth growth =
        mirror->Allocate(walk, config_.volume.box(), config_.max_new_blocks);
    for (const BlockCoord& coord : growth.added) {
        const BlockId id = map.Allocate(coord);
        TESSERA_CHECK(
            id == mirror->size() - static_cast<BlockId>(growth.added.size() - added_.size()),
            "block {} has a different id on the device", id);
        added_.push_back(id);
    }
    report.new_blocks = static_cast<std::int64_t>(added_.size());
    report.refused_blocks = growth.wanted - report.new_blocks;
    report.map_full = growth.full;
}

void DeviceIntegrator::Fuse(const PreparedFrame& frame, const View& view, BlockMap& map,
                            Report& report) {
    changed_ = &none_;
    if (!uploaded_ || frame.valid_depth_pixels == 0) return;
    DeviceMap& mirror = *device_.MirrorOf(map);
    FusionArguments a = MakeFusionArguments(frame, view, camera_, config_, map.config(), revision_);
    BuildDepthTiles(device_.stream_, device_.frame_.depth_m(), a.width, a.height,
                    device_.frame_.tiles());
    const DepthTileView tiles{device_.frame_.tiles(), (a.width + kDepthTilePx - 1) / kDepthTilePx,
                              (a.height + kDepthTilePx - 1) / kDepthTilePx};
    const int count = mirror.FindVisible(
        tiles, MakeViewCone(camera_, view.T_world_camera, frame.farthest_m, map.config()));
    const DeviceMapView layers = mirror.view();
    a.field = layers.field;
    a.weight = layers.weight;
    a.colour = layers.colour;
    a.coords = layers.coords;
    a.depth_m = device_.frame_.depth_m();
    a.packed_colour = frame.has_colour ? device_.frame_.packed_colour() : nullptr;
    a.gone_m = device_.frame_.UploadGone(frame);
    FuseBlocks(device_.stream_, a, mirror.visible(), count, layers.revision, revision_);
    changed_ids_.resize(static_cast<std::size_t>(count));
    device_.stream_.Download(changed_ids_.data(), mirror.visible(),
                             changed_ids_.size() * sizeof(BlockId));
    device_.stream_.Wait();
    for (const BlockId id : changed_ids_) map.MarkChanged(id, revision_);
    report.fused_blocks = count;
    changed_ = &changed_ids_;
}

void DeviceIntegrator::Bring(BlockMap& map) {
    if (brought_map_ != map.identity() || brought_revision_ == revision_) return;
    device_.MirrorOf(map)->DownloadSince(
        brought_revision_ + 1, voxels_, [&](const BlockVoxels& part) {
            for (std::size_t i = 0; i < part.ids.size(); ++i) {
                const std::size_t at = i * kBlockVoxels;
                std::copy_n(part.field.data() + at, kBlockVoxels, map.field(part.ids[i]));
                std::copy_n(part.weight.data() + at, kBlockVoxels, map.weight(part.ids[i]));
                std::copy_n(part.colour.data() + at, kBlockVoxels, map.colour(part.ids[i]));
            }
        });
    brought_revision_ = revision_;
}

}  // namespace tessera::TESSERA_DEVICE
