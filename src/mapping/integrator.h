// Integrates frames into the map: allocates blocks along the measured band, then updates every
// voxel that the frame sees. The only writer of a BlockMap. Owner thread only; uses TBB internally
// and gives the same result for any number of threads.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/cpu.h"
#include "core/frame_motion.h"
#include "mapping/allocation_kernels.h"
#include "mapping/block_map.h"
#include "mapping/fusion_arguments.h"
#include "mapping/map_volume.h"
#include "mapping/prepared_frame.h"
#include "mapping/visible_blocks.h"

namespace tessera {

class Integrator {
  public:
    struct Config {
        DistanceWeight distance_weight = DistanceWeight::kDepthNoise;
        ColourWeighting colour_weighting = ColourWeighting::kCosine;
        double epsilon_m = 0.025;  // for linear_exp, [B14] eq. 13
        double sigma = 60.0;       // for linear_exp, 1/m^2; the paper gives no value
        double max_weight = 128.0;
        double max_colour_weight = 64.0;
        int max_new_blocks = 60000;
        MapVolume volume;

        void Describe(ConfigParameters& parameters);
    };

    // What one integration needs besides the images.
    struct View {
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
        FrameMotion motion;
        float gain = 1.0f, offset = 0.0f;  // map intensity = gain * image intensity + offset
        float weight = 1.0f;  // for the whole frame, in (0, 1]; their sum for an average of frames
        float colour_weight = 1.0f;  // 0: the frame was fused without its colour
    };

    struct Report {
        std::int64_t new_blocks = 0;
        std::int64_t refused_blocks = 0;  // exceeded max_new_blocks or the map's capacity
        bool no_memory = false;           // blocks were refused because the system has too little
        bool map_full = false;            // the map's capacity is exhausted
        std::int64_t fused_blocks = 0;
        double allocate_ms = 0, fuse_ms = 0;
    };

    Integrator(const Config& config, const PinholeCamera& camera,
               VectorPath path = VectorPath::kAuto);
    virtual ~Integrator() = default;

    // Whether blocks are added along the measured band.
    enum class Blocks { kNewToo, kExisting };
    Report Integrate(const PreparedFrame& frame, const View& view, BlockMap& map,
                     Blocks blocks = Blocks::kNewToo);
    // Ids changed by the last call, in increasing order.
    const std::vector<BlockId>& changed_blocks() const { return *changed_; }
    // Blocks added by the last call, in order of allocation.
    const std::vector<BlockId>& added_blocks() const { return added_; }
    // Counts the integrations. Blocks changed by the n-th one carry BlockMap::revision n.
    std::uint32_t revision() const { return revision_; }
    // Call after changing the map by other means: marks all its blocks, or these, with a new
    // revision.
    void MarkAllChanged(BlockMap& map);
    void MarkChanged(BlockMap& map, std::span<const BlockId> blocks);
    // Continues after this many integrations, for a map that they built.
    void SetRevision(std::uint32_t revision) { revision_ = revision; }
    // If a device holds the voxels, copies the changed ones to `map`. The blocks of `map`, without
    // their voxels, are always up to date with the last Integrate.
    virtual void Bring(BlockMap&) {}
    // Describes the limit behind map_full.
    virtual std::string limit() const { return "there is no more room for the map"; }

  protected:
    virtual void Allocate(const PreparedFrame& frame, const View& view, BlockMap& map,
                          Report& report);
    virtual void Fuse(const PreparedFrame& frame, const View& view, BlockMap& map, Report& report);

    Config config_;
    PinholeCamera camera_;
    std::uint32_t revision_ = 0;
    std::vector<BlockId> added_;
    const std::vector<BlockId>* changed_;
    std::vector<BlockId> none_;

  private:
    // The number of new blocks for which there is memory; `wanted` suffices.
    std::int64_t RoomFor(std::int64_t wanted, const BlockMap& map);

    VectorPath path_;
    VisibleBlocks visible_;
    std::int64_t sure_blocks_ = 0;                  // these need no further look at the free memory
    std::vector<std::vector<BlockCoord>> missing_;  // per band of rows
    std::vector<BlockCoord> new_blocks_;
};

// The arguments of WalkRay for a frame taken at this pose.
BandWalk MakeBandWalk(const PreparedFrame& frame, const PinholeCamera& camera,
                      const Eigen::Isometry3d& T_world_camera, const BlockMap::Config& map);

// The fusion arguments for a frame and its view. The caller fills in the map's layers and the
// images.
FusionArguments MakeFusionArguments(const PreparedFrame& frame, const Integrator::View& view,
                                    const PinholeCamera& camera, const Integrator::Config& config,
                                    const BlockMap::Config& map, std::uint32_t revision);

}  // namespace tessera
