#include "tracking/sdf_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace tessera {
namespace {

using L = SumLayout;

// Copies a rigid motion, scaled to voxels, into the hot loop's arguments.
void SetSdfPose(const Eigen::Isometry3d& T_world_camera, const Eigen::Vector3d& origin_m,
                double voxel_m, SdfArguments& a) {
    const Eigen::Vector3d t = (T_world_camera.translation() - origin_m) / voxel_m;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            a.rotation[3 * i + j] = static_cast<float>(T_world_camera.linear()(i, j) / voxel_m);
        a.translation[i] = static_cast<float>(t(i));
    }
}

}  // namespace

struct SdfTracker::State : FoundPose {
    Eigen::Isometry3d T_world_camera;
    Eigen::Vector3d origin_m;
    SdfArguments arguments{};
    PoseStep step;
    bool failed = false;
};

SdfTracker::SdfTracker(const Config& config, const PinholeCamera& camera, const TrackJudge& judge,
                       ResidualModel& model, bool use_colour, SdfSums* sums)
    : config_(config),
      finest_step_px_(FinestStep(config.finest_step_px, kStepAtVga_px, camera)),
      camera_(camera),
      judge_(judge),
      residual_model_(model),
      use_colour_(use_colour),
      own_sums_(sums != nullptr ? nullptr : std::make_unique<CpuSdfSums>()),
      sums_(sums != nullptr ? *sums : *own_sums_),
      points_(static_cast<std::size_t>(LevelsThatFit(config.levels, finest_step_px_, camera))) {
    config_.levels = static_cast<int>(points_.size());
}

TrackResult SdfTracker::Track(const TrackInput& input) {
    State state;
    state.T_world_camera = input.T_world_camera_starts.front();
    if (use_colour_) {
        state.gain = residual_model_.gain();
        state.offset = residual_model_.offset();
        if (input.frame.has_colour) state.alpha = residual_model_.alpha();
    }
    for (int level = config_.levels - 1; level >= 0 && !state.failed; --level) {
        PrepareLevel(input, level, state);
        if (level == config_.levels - 1) ChooseStart(input, state);
        if (!state.failed) RunLevel(input, level, state);
    }
    state.T_world_local = Eigen::Isometry3d(Eigen::Translation3d(state.origin_m));
    state.T_local_camera = state.T_world_local.inverse() * state.T_world_camera;
    state.points = points_[0].valid();
    state.valid = state.step.valid;
    return Conclude(
        input, state, MakeResidualArguments(input.frame, camera_, points_[0], residuals_),
        [this](const ResidualArguments& a) { return sums_.SumResiduals(a); },
        config_.distance_scale_m, judge_, residual_model_);
}

// Without points the level cannot be tracked. A device may have had no room for them.
void SdfTracker::MakePoints(const TrackInput& input, int step, FramePoints& points, State& state) {
    const DepthWeight weight{config_.noise_depth_m, input.nearest_m};
    sums_.SetPoints(input.map, input.frame,
                    MakePointArguments(input.frame, camera_, state.motion, step, weight,
                                       state.alpha > 0, config_.chroma),
                    points);
    state.failed = points.valid() == 0;
    if (state.failed) state.step.valid = false;
}

// Prepares the points, their intensities and the map for the hot loop, at every (finest_step_px_ <<
// level)-th pixel.
void SdfTracker::PrepareLevel(const TrackInput& input, int level, State& state) {
    FramePoints& points = points_[static_cast<std::size_t>(level)];
    state.motion = use_colour_ ? residual_model_.Timed(input.motion) : input.motion;
    if (input.since_last_s > 0)  // velocity since the last frame, at the present estimate
        state.motion.twist_per_s =
            Se3Log(input.T_world_camera_last.inverse() * state.T_world_camera) / input.since_last_s;
    MakePoints(input, finest_step_px_ << level, points, state);
    const double block_m = input.map.config().voxel_size_m * kBlockSide;
    const Eigen::Vector3d origin_block =
        (state.T_world_camera.translation() / block_m).array().floor();
    state.origin_m = origin_block * block_m;
    state.scene_depth_m = 0.5 * (input.frame.nearest_m + input.frame.farthest_m);
    SdfArguments& a = state.arguments;
    a = {};
    static_cast<BlockMapView&>(a) = input.map.view();
    for (int i = 0; i < 3; ++i) a.origin_block[i] = static_cast<std::int32_t>(origin_block(i));
    a.x = points.x.data();
    a.y = points.y.data();
    a.z = points.z.data();
    a.intensity = points.intensity.data();
    a.weight = points.weight.data();
    a.use_intensity = state.alpha > 0;
    if (a.use_intensity && config_.chroma) {
        TESSERA_CHECK(input.map.has_colours(), "chroma is aligned with a map without colours");
        a.cb = points.cb.data();
        a.cr = points.cr.data();
        a.colour = input.map.colours();
    }
    a.normalise = config_.normalise;
    a.distance_scale_m = static_cast<float>(config_.distance_scale_m);
    a.intensity_scale = static_cast<float>(residual_model_.config().intensity_scale);
    if (level > 0) return;
    residuals_.Resize(points.count());
    a.distance_residual = residuals_.distance_m.data();
    a.intensity_residual = state.alpha > 0 ? residuals_.intensity.data() : nullptr;
    for (std::size_t k = 0; k < 3; ++k) a.gradient[k] = residuals_.gradient[k].data();
}

PoseSums SdfTracker::SumAt(const TrackInput& input, const FramePoints& points, State& state) {
    SetSdfPose(state.T_world_camera, state.origin_m, input.map.config().voxel_size_m,
               state.arguments);
    state.arguments.gain = static_cast<float>(state.gain);
    state.arguments.offset = static_cast<float>(state.offset);
    return sums_.Sum(state.arguments, points.count());
}

// Chooses the start that fits best on the coarsest level.
void SdfTracker::ChooseStart(const TrackInput& input, State& state) {
    if (state.failed || input.T_world_camera_starts.size() < 2) return;
    const FramePoints& points = points_.back();
    double best = std::numeric_limits<double>::infinity();
    Eigen::Isometry3d T_best = state.T_world_camera;
    for (const Eigen::Isometry3d& start : input.T_world_camera_starts) {
        state.T_world_camera = start;
        const PoseSums sums = SumAt(input, points, state);
        const double misfit = Misfit(sums, sums[L::kKnown], static_cast<double>(points.valid()),
                                     config_.distance_scale_m, state.alpha);
        if (misfit >= best) continue;
        best = misfit;
        T_best = start;
    }
    state.T_world_camera = T_best;
}

// Gauss-Newton on [B14] eq. 11.
void SdfTracker::RunLevel(const TrackInput& input, int level, State& state) {
    const FramePoints& points = points_[static_cast<std::size_t>(level)];
    SolverOptions& options = state.options;
    options.alpha = state.alpha;
    options.estimate_brightness = state.alpha > 0 && residual_model_.config().brightness;
    options.least_damping =
        LeastDamping(residual_model_.scales(), judge_.expected_within_m(), level);
    const int iterations = level == 0 ? config_.fine_iterations : config_.coarse_iterations;
    bool removes_shading = false;
    for (int i = 0; i < iterations; ++i) {
        state.sums = SumAt(input, points, state);
        if (level == 0 && i == 0) {
            removes_shading = state.alpha > 0 && residual_model_.TakesForShading(state.sums);
            if (removes_shading) state.rms_with_shading = IntensityRms(state.sums);
        }
        if (removes_shading && i > 0) {
            // From the second step on, because what a wrong pose leaves looks like shading, too.
            sums_.RemoveShading(MakeShadingArguments(points_[0], residuals_, state.gain,
                                                     residual_model_.config().intensity_scale));
            if (i == 1) state.sums = SumAt(input, points, state);
        }
        ++state.iterations;
        options.brightness_prior =
            residual_model_.config().brightness_prior * state.sums[L::kBrightness + 2];
        state.step =
            SolvePoseStep(state.sums, options, state.gain, state.offset,
                          state.T_world_camera.translation() - state.origin_m, state.scene_depth_m);
        state.failed = !state.step.valid;
        if (state.failed) return;
        // The increment acts about the local origin: conjugate it with the shift.
        const Eigen::Translation3d shift(state.origin_m);
        state.T_world_camera =
            shift * Se3Exp(state.step.increment) * shift.inverse() * state.T_world_camera;
        state.gain = std::clamp(state.gain + state.step.gain_change, 0.5, 2.0);
        state.offset = std::clamp(state.offset + state.step.offset_change, -0.3, 0.3);
        const double turn = state.step.increment.head<3>().norm();
        const double move = state.step.increment.tail<3>().norm();
        const double tolerance = level == 0 ? 1.0 : 4.0;
        const bool converged = turn < 5e-5 * tolerance && move < 5e-5 * tolerance;
        if (converged && (i > 0 || !removes_shading)) break;
    }
    state.T_world_camera = Normalised(state.T_world_camera);
}

void SdfTracker::Config::Describe(ConfigParameters& p) {
    p.Add("distance_scale_m", distance_scale_m, {1e-4, 10.0}, "m",
          "Huber scale of distances: larger residuals count linearly; a scale above the truncation "
          "gives least squares, as in [B14]");
    p.Add("noise_depth_m", noise_depth_m, {0.0, 100.0}, "m",
          "a point's weight is the inverse variance of its distance: nearer than this most of the "
          "error is one of direction, which grows with depth, farther away one of disparity, which "
          "grows with its square; 0: equal weights, [B14]");
    p.Add("normalise", normalise,
          "divide the field's distance by the length of its gradient, because distances measured "
          "along slanted rays are too long; off is [B14]");
    p.Add(
        "chroma", chroma,
        "align chroma as well as luma: the weighted error of all three colour channels, [B14] eq. "
        "6 and 7; helps where neighbouring colours are equally bright");
    p.Add("finest_step_px", finest_step_px, {0, 16}, "px",
          "pixel step of the finest level, in both directions; 0: 3 at 640 x 480, and in "
          "proportion at other sizes, but at least 2; [B14] uses 1");
    p.Add("levels", levels, {1, 5}, "",
          "number of levels; each coarser level doubles the step; fewer where the coarsest would "
          "have less than 6 points on a side");
    p.Add("coarse_iterations", coarse_iterations, {1, 100}, "",
          "maximum number of Gauss-Newton steps on each coarse level");
    p.Add("fine_iterations", fine_iterations, {1, 100}, "",
          "maximum number of Gauss-Newton steps on the finest level");
}

}  // namespace tessera
