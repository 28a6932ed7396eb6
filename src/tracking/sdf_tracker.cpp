#include "tracking/sdf_tracker.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera {
namespace {

using L = SdfSumLayout;

constexpr int kTile = 2048;  // points per partial sum; fixed, so that sums have a fixed order

// Copies a rigid motion with the voxel scale into the hot loop's arguments.
void SetPose(const Eigen::Isometry3d& T_world_camera, const Eigen::Vector3d& origin_m, double voxel_m,
             SdfArguments& a) {
    const Eigen::Vector3d t = (T_world_camera.translation() - origin_m) / voxel_m;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            a.rotation[3 * i + j] = static_cast<float>(T_world_camera.linear()(i, j) / voxel_m);
        a.translation[i] = static_cast<float>(t(i));
    }
}

}  // namespace

struct SdfTracker::State {
    Eigen::Isometry3d T_world_camera;
    FrameMotion motion;
    Eigen::Vector3d origin_m;
    double gain, offset;
    double alpha;
    double scene_depth_m = 1;
    SdfArguments arguments{};
    SdfSums sums;
    SdfStep step;
    int iterations = 0;
    bool failed = false;
};

SdfTracker::SdfTracker(const Config& config, const PinholeCamera& camera, VectorPath path)
    : config_(config),
      camera_(camera),
      use_avx2_(path == VectorPath::kAvx2 || (path == VectorPath::kAuto && CpuHasAvx2())),
      shutter_(config.shutter, camera),
      points_(static_cast<std::size_t>(config.levels)) {
    Reset();
}

void SdfTracker::Reset() {
    alpha_ = config_.alpha;
    gain_ = 1;
    offset_ = 0;
    shutter_.Reset();
    distance_variance_ = intensity_variance_ = 0;
}

TrackResult SdfTracker::Track(const TrackInput& input) {
    State state;
    state.T_world_camera = input.T_world_camera_starts.front();
    state.gain = gain_;
    state.offset = offset_;
    state.alpha = input.frame.has_colour() ? alpha_ : 0.0;
    for (int level = config_.levels - 1; level >= 0 && !state.failed; --level) {
        PrepareLevel(input, level, state);
        if (level == config_.levels - 1) ChooseStart(input, state);
        if (!state.failed) RunLevel(input, level, state);
    }

    TrackResult result;
    result.T_world_camera = state.T_world_camera;
    result.motion = state.motion;
    result.alpha = state.alpha;
    result.gain = state.gain;
    result.offset = state.offset;
    result.iterations = state.iterations;
    Judge(input, state.sums, state.step, result);
    if (result.status != TrackStatus::kLost) Learn(input, state, result);
    return result;
}

// What one frame teaches about the camera and the residuals, for the frames to come.
void SdfTracker::Learn(const TrackInput& input, const State& state, const TrackResult& result) {
    gain_ = state.gain;
    offset_ = state.offset;
    if (state.alpha <= 0) return;
    shutter_.Update(input.frame, points_[0], intensity_residual_, state.motion, state.gain, result.intensity_rms);
    if (config_.alpha_mode == AlphaMode::kAuto) UpdateAlpha(points_[0]);
}

// Points, their intensities and the map as the hot loop takes them, for every (finest_step_px << level)-th pixel.
void SdfTracker::PrepareLevel(const TrackInput& input, int level, State& state) {
    SdfPoints& points = points_[static_cast<std::size_t>(level)];
    state.motion = input.motion;
    state.motion.colour_delay_s += shutter_.delay_s();
    state.motion.colour_readout_s += shutter_.readout_s();
    if (input.since_last_s > 0)  // the velocity of the last interval, as far as this level knows it
        state.motion.twist_per_s =
            Se3Log(input.T_world_camera_last.inverse() * state.T_world_camera) / input.since_last_s;
    points.Build(input.frame, camera_, state.motion, config_.finest_step_px << level, config_.depth_exponent);
    state.failed = points.valid() == 0;
    if (state.alpha > 0) points.SampleIntensity(input.frame, camera_, state.motion);
    const BlockMap::View map = input.map.view();
    const double block_m = input.map.config().voxel_size_m * kBlockSide;
    const Eigen::Vector3d origin_block = (state.T_world_camera.translation() / block_m).array().floor();
    state.origin_m = origin_block * block_m;
    state.scene_depth_m = 0.5 * (input.frame.nearest_m + input.frame.farthest_m);
    SdfArguments& a = state.arguments;
    a = {};
    a.field = map.field;
    a.neighbours = map.neighbours;
    a.table = map.table;
    a.coords = map.coords;
    a.table_mask = map.table_mask;
    a.voxel_size_m = map.voxel_size_m;
    a.truncation_m = map.truncation_m;
    for (int i = 0; i < 3; ++i) a.origin_block[i] = static_cast<std::int32_t>(origin_block(i));
    a.x = points.x.data();
    a.y = points.y.data();
    a.z = points.z.data();
    a.intensity = points.intensity.data();
    a.weight = points.weight.data();
    a.alpha = static_cast<float>(state.alpha);
    a.normalise = config_.normalise;
    a.distance_scale_m = static_cast<float>(config_.distance_scale_m);
    a.intensity_scale = static_cast<float>(config_.intensity_scale);
    a.inlier_distance_m = 0.5f * map.truncation_m;
    if (level > 0) return;
    distance_residual_.resize(static_cast<std::size_t>(points.count()));
    intensity_residual_.resize(static_cast<std::size_t>(points.count()));
    a.distance_residual = distance_residual_.data();
    a.intensity_residual = state.alpha > 0 ? intensity_residual_.data() : nullptr;
}

SdfSums SdfTracker::SumAt(const TrackInput& input, const SdfPoints& points, State& state) const {
    SetPose(state.T_world_camera, state.origin_m, input.map.config().voxel_size_m, state.arguments);
    state.arguments.gain = static_cast<float>(state.gain);
    state.arguments.offset = static_cast<float>(state.offset);
    return Sum(state.arguments, points);
}

// The start with the least energy per weight on the coarsest level; points outside the known band count as badly
// fitting, or a start that sees nothing of the map would win.
void SdfTracker::ChooseStart(const TrackInput& input, State& state) {
    if (state.failed || input.T_world_camera_starts.size() < 2) return;
    const SdfPoints& points = points_.back();
    double best = std::numeric_limits<double>::infinity();
    Eigen::Isometry3d T_best = state.T_world_camera;
    for (const Eigen::Isometry3d& start : input.T_world_camera_starts) {
        state.T_world_camera = start;
        const SdfSums sums = SumAt(input, points, state);
        const double scale2 = config_.distance_scale_m * config_.distance_scale_m;
        const double unknown = 1.0 - sums[L::kKnown] / static_cast<double>(points.valid());
        double energy = unknown * (1.0 + state.alpha);
        if (sums[L::kDistanceWeight] > 0) energy += sums[L::kDistanceError] / (sums[L::kDistanceWeight] * scale2);
        if (sums[L::kIntensityWeight] > 0)
            energy += state.alpha * sums[L::kIntensityError] / (sums[L::kIntensityWeight] * scale2);
        if (energy >= best) continue;
        best = energy;
        T_best = start;
    }
    state.T_world_camera = T_best;
}

// Gauss-Newton on [B14] eq. 11.
void SdfTracker::RunLevel(const TrackInput& input, int level, State& state) {
    const SdfPoints& points = points_[static_cast<std::size_t>(level)];
    SdfSolverOptions options;
    options.estimate_brightness = config_.brightness;
    options.brightness_prior = config_.brightness_prior;
    options.min_eigenvalue = config_.min_eigenvalue;
    const int iterations = level == 0 ? config_.fine_iterations : config_.coarse_iterations;
    for (int i = 0; i < iterations; ++i) {
        state.sums = SumAt(input, points, state);
        ++state.iterations;
        state.step = SolveSdfStep(state.sums, options, state.gain, state.offset,
                                  state.T_world_camera.translation() - state.origin_m, state.scene_depth_m);
        state.failed = !state.step.valid;
        if (state.failed) return;
        // The increment acts about the local origin: conjugate it with the shift.
        const Eigen::Translation3d shift(state.origin_m);
        state.T_world_camera = shift * Se3Exp(state.step.increment) * shift.inverse() * state.T_world_camera;
        state.gain = std::clamp(state.gain + state.step.gain_change, 0.5, 2.0);
        state.offset = std::clamp(state.offset + state.step.offset_change, -0.3, 0.3);
        const double turn = state.step.increment.head<3>().norm();
        const double move = state.step.increment.tail<3>().norm();
        const double tolerance = level == 0 ? 1.0 : 4.0;
        if (turn < 5e-5 * tolerance && move < 5e-5 * tolerance) break;
    }
    state.T_world_camera.linear() = Eigen::Quaterniond(state.T_world_camera.linear()).normalized().toRotationMatrix();
}

SdfSums SdfTracker::Sum(const SdfArguments& a, const SdfPoints& points) const {
    const int tiles = (points.count() + kTile - 1) / kTile;
    std::vector<SdfSums> partial(static_cast<std::size_t>(tiles));
    tbb::parallel_for(0, tiles, [&](int tile) {
        const int first = tile * kTile, last = std::min(points.count(), first + kTile);
        double* sums = partial[static_cast<std::size_t>(tile)].value;
#ifdef TESSERA_HAVE_AVX2
        if (use_avx2_) return avx2::SumSdfPoints(a, first, last, sums);
#endif
        baseline::SumSdfPoints(a, first, last, sums);
    });
    SdfSums total;
    for (const SdfSums& sums : partial) total += sums;
    return total;
}

}  // namespace tessera
