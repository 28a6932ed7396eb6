#include "mapping/integrator.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/memory.h"
#include "core/stopwatch.h"
#include "mapping/allocation_kernels.h"
#include "mapping/fusion_simd.h"

namespace tessera {
namespace {

VoxelToCamera MakeVoxelToCamera(const Eigen::Isometry3d& T_camera_world,
                                const Eigen::Vector3d& origin_m) {
    VoxelToCamera out{};
    const Eigen::Vector3d t = T_camera_world * origin_m;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            out.rotation[3 * i + j] = static_cast<float>(T_camera_world.linear()(i, j));
        out.translation[i] = static_cast<float>(t[i]);
    }
    return out;
}

}  // namespace

void Integrator::Config::Describe(ConfigParameters& p) {
    p.AddChoice("distance_weight", distance_weight,
                {{"constant", DistanceWeight::kConstant},
                 {"linear_exp", DistanceWeight::kLinearExp},
                 {"depth_noise", DistanceWeight::kDepthNoise}},
                "weight of a measurement: constant ([D18] eq. 7), falling off behind the surface "
                "([B14] eq. 13), or (1 m / depth)^2 to match the noise of structured light");
    p.AddChoice("colour_weighting", colour_weighting,
                {{"cosine", ColourWeighting::kCosine}, {"same", ColourWeighting::kSame}},
                "weight of a colour: the distance weight times the cosine of the angle to the "
                "optical axis ([B14] eq. 17), or the distance weight ([D18] eq. 6)");
    p.Add("epsilon_m", epsilon_m, {0.0, 1.0}, "m",
          "linear_exp: full weight up to this distance behind the surface");
    p.Add("sigma", sigma, {0.0, 1e6}, "1/m^2",
          "linear_exp: how fast the weight falls beyond epsilon_m");
    p.Add("max_weight", max_weight, {1.0, kMaxWeight}, "",
          "memory of the running average, in frames at 1 m; lower it if the scene changes");
    p.Add("max_colour_weight", max_colour_weight, {1.0, kMaxWeight}, "",
          "memory of the running average of colour, in frames at 1 m");
    p.Add("max_new_blocks", max_new_blocks, {100, 1000000}, "blocks",
          "maximum number of blocks that one frame may add; limits the cost of a corrupt frame");
    p.Section("volume", [&](ConfigParameters& s) { volume.Describe(s); });
}

Integrator::Integrator(const Config& config, const PinholeCamera& camera, VectorPath path)
    : config_(config), camera_(camera), changed_(&none_), path_(path) {}

BandWalk MakeBandWalk(const PreparedFrame& frame, const PinholeCamera& camera,
                      const Eigen::Isometry3d& T_world_camera, const BlockMap::Config& map) {
    const double block_m = map.voxel_size_m * kBlockSide;
    BandWalk walk{};
    walk.depth_m = frame.depth_m.data();
    walk.width = frame.width;
    walk.height = frame.height;
    // Space rays at most half a block apart at the farthest depth.
    walk.step = std::clamp(
        static_cast<int>(0.5 * block_m * camera.fx / std::max(frame.farthest_m, 0.1f)), 1, 8);
    walk.fx = camera.fx;
    walk.fy = camera.fy;
    walk.cx = camera.cx;
    walk.cy = camera.cy;
    walk.block_m = static_cast<float>(block_m);
    walk.band = map.band();
    const Eigen::Matrix3f R = T_world_camera.linear().cast<float>() / static_cast<float>(block_m);
    const Eigen::Vector3d t = T_world_camera.translation() / block_m;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) walk.rotation[3 * i + j] = R(i, j);
        walk.block[i] = static_cast<std::int32_t>(std::floor(t[i]));
        walk.part[i] = static_cast<float>(t[i] - std::floor(t[i]));
    }
    return walk;
}

Integrator::Report Integrator::Integrate(const PreparedFrame& frame, const View& view,
                                         BlockMap& map, Blocks blocks) {
    Report report;
    ++revision_;
    added_.clear();
    Stopwatch watch;
    if (blocks == Blocks::kNewToo) Allocate(frame, view, map, report);
    report.allocate_ms = watch.LapMs();
    Fuse(frame, view, map, report);
    report.fuse_ms = watch.LapMs();
    return report;
}

void Integrator::MarkAllChanged(BlockMap& map) {
    ++revision_;
    changed_ = &none_;
    for (BlockId id = 1; id < map.size(); ++id)
        if (!map.IsFree(id)) map.MarkChanged(id, revision_);
}

void Integrator::MarkChanged(BlockMap& map, std::span<const BlockId> blocks) {
    ++revision_;
    for (const BlockId id : blocks) map.MarkChanged(id, revision_);
}

void Integrator::Allocate(const PreparedFrame& frame, const View& view, BlockMap& map,
                          Report& report) {
    const BandWalk walk = MakeBandWalk(frame, camera_, view.T_world_camera, map.config());
    const WorldBox box = config_.volume.box();
    const double block_m = map.config().voxel_size_m * kBlockSide;
    constexpr int kRowsPerBand = 4;
    const int bands = (walk.rows() + kRowsPerBand - 1) / kRowsPerBand;
    missing_.resize(static_cast<std::size_t>(bands));
    tbb::parallel_for(0, bands, [&](int band) {
        std::vector<BlockCoord>& missing = missing_[static_cast<std::size_t>(band)];
        missing.clear();
        BlockCoord last{kBlockLimit, 0, 0};
        const auto visit = [&](const BlockCoord& c) {
            if (c == last) return;
            last = c;
            if (map.Find(c) == kUnknownBlock && InLimits(c) && Meets(box, c, block_m))
                missing.push_back(c);
        };
        for (int row = band * kRowsPerBand; row < std::min(walk.rows(), (band + 1) * kRowsPerBand);
             ++row)
            for (int column = 0; column < walk.columns(); ++column)
                WalkRay(walk, column, row, visit);
        std::sort(missing.begin(), missing.end());
        missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    });

    new_blocks_.clear();
    for (const auto& missing : missing_)
        new_blocks_.insert(new_blocks_.end(), missing.begin(), missing.end());
    std::sort(new_blocks_.begin(), new_blocks_.end());
    new_blocks_.erase(std::unique(new_blocks_.begin(), new_blocks_.end()), new_blocks_.end());
    const auto wanted = static_cast<std::int64_t>(new_blocks_.size());
    const std::int64_t room = RoomFor(wanted, map);
    report.no_memory = room < std::min<std::int64_t>(wanted, config_.max_new_blocks);
    for (const BlockCoord& c : new_blocks_) {
        if (report.new_blocks >= config_.max_new_blocks) break;
        const BlockId id = report.new_blocks < room ? map.Allocate(c) : kUnknownBlock;
        report.map_full = id == kUnknownBlock;
        if (report.map_full) break;
        added_.push_back(id);
        ++report.new_blocks;
    }
    report.refused_blocks = wanted - report.new_blocks;
}

std::int64_t Integrator::RoomFor(std::int64_t wanted, const BlockMap& map) {
    if (wanted <= sure_blocks_) {
        sure_blocks_ -= wanted;
        return wanted;
    }
    constexpr double kMb = 1 << 20, kLeastFree_mb = 128;
    // A block, its mesh, and its copy in a checkpoint.
    constexpr double kCopies = 3;
    constexpr std::int64_t kMostUnchecked = 4096;
    const double others_mb = kLeastFree_mb + (kCopies - 1) * static_cast<double>(map.bytes()) / kMb;
    const double block_mb = kCopies * kBlockVoxels * map.bytes_per_voxel() / kMb;
    const auto room =
        static_cast<std::int64_t>(std::clamp((FreeMemoryMb() - others_mb) / block_mb, 0.0, 1e9));
    sure_blocks_ = std::clamp<std::int64_t>((room - wanted) / 2, 0, kMostUnchecked);
    return room;
}

FusionArguments MakeFusionArguments(const PreparedFrame& frame, const Integrator::View& view,
                                    const PinholeCamera& camera, const Integrator::Config& config,
                                    const BlockMap::Config& map, std::uint32_t revision) {
    const double voxel_m = map.voxel_size_m;
    // Use coordinates relative to a voxel near the camera, to keep single precision accurate far
    // from the world's origin.
    const Eigen::Vector3d origin = (view.T_world_camera.translation() / voxel_m).array().round();
    const Eigen::Isometry3d T_camera_world = view.T_world_camera.inverse();

    FusionArguments a{};
    a.width = frame.width;
    a.height = frame.height;
    a.fx = static_cast<float>(camera.fx);
    a.fy = static_cast<float>(camera.fy);
    a.cx = static_cast<float>(camera.cx);
    a.cy = static_cast<float>(camera.cy);
    a.frame = revision;
    a.to_camera = MakeVoxelToCamera(T_camera_world, origin * voxel_m);
    for (int i = 0; i < 6; ++i) a.twist_per_s[i] = static_cast<float>(view.motion.twist_per_s(i));
    a.colour_delay_s = static_cast<float>(view.motion.colour_delay_s);
    a.depth_readout_s = static_cast<float>(view.motion.depth_readout_s);
    a.colour_readout_s = static_cast<float>(view.motion.colour_readout_s);
    a.moving = !view.motion.twist_per_s.isZero();
    for (int i = 0; i < 3; ++i) a.origin[i] = static_cast<std::int32_t>(origin[i]);
    a.voxel_size_m = static_cast<float>(voxel_m);
    a.band = map.band();
    a.distance_weight = config.distance_weight;
    a.colour_weighting = config.colour_weighting;
    a.epsilon_m = static_cast<float>(config.epsilon_m);
    a.sigma = static_cast<float>(config.sigma);
    a.max_weight = static_cast<float>(config.max_weight);
    a.max_colour_weight = static_cast<float>(config.max_colour_weight);
    a.gain = view.gain;
    a.offset = view.offset;
    a.frame_weight = view.weight;
    a.frame_colour_weight = view.colour_weight;
    return a;
}

void Integrator::Fuse(const PreparedFrame& frame, const View& view, BlockMap& map, Report& report) {
    changed_ = &none_;
    if (frame.valid_depth_pixels == 0) return;
    const std::vector<BlockId>& blocks =
        visible_.Find(map, camera_, view.T_world_camera, frame.depth_m, frame.farthest_m);
    FusionArguments a = MakeFusionArguments(frame, view, camera_, config_, map.config(), revision_);
    a.field = map.field(0);
    a.weight = map.weight(0);
    a.colour = map.colour(0);
    a.coords = map.view().coords;
    a.depth_m = frame.depth_m.data();
    a.packed_colour = frame.has_colour ? frame.packed_colour.data() : nullptr;
    a.gone_m = frame.gone_m.empty() ? nullptr : frame.gone_m.data();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 64),
                      [&](const auto& range) {
                          const auto count = static_cast<std::int32_t>(range.size());
                          TESSERA_SIMD(path_, FuseBlocks)(a, blocks.data() + range.begin(), count);
                      });
    for (const BlockId id : blocks) map.MarkChanged(id, revision_);
    report.fused_blocks = static_cast<std::int64_t>(blocks.size());
    changed_ = &blocks;
}

}  // namespace tessera
