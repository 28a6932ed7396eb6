#include "tracking/icp_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tracking/set_view.h"

namespace tessera {
namespace {

// Fraction of the energy. A smaller predicted decrease counts as converged, because rounding would
// decide whether the energy falls.
constexpr double kLeastFall = 1e-6;
constexpr double kAnotherView_m = 0.15, kAnotherView_rad = 0.15;
constexpr double kIntensityGateScales = 5.0;

}  // namespace

// The local frame is the predicted view's.
struct IcpTracker::State : FoundPose {
    IcpArguments arguments{};
    LevenbergMarquardt damping;
    PoseStep step;
    bool failed = false;
};

IcpTracker::IcpTracker(const Config& config, const PinholeCamera& camera, const TrackJudge& judge,
                       ResidualModel& model, bool use_colour,
                       std::unique_ptr<ViewPredictor> predictor, IcpSums* sums)
    : config_(config),
      finest_step_px_(FinestStep(config.finest_step_px, kStepAtVga_px, camera)),
      camera_(camera),
      judge_(judge),
      residual_model_(model),
      use_colour_(use_colour),
      predictor_(std::move(predictor)),
      own_sums_(sums != nullptr ? nullptr : std::make_unique<CpuIcpSums>()),
      sums_(sums != nullptr ? *sums : *own_sums_),
      points_(static_cast<std::size_t>(LevelsThatFit(config.levels, finest_step_px_, camera))) {
    config_.levels = static_cast<int>(points_.size());
}

TrackResult IcpTracker::Track(const TrackInput& input) {
    State state;
    state.scene_depth_m = 0.5 * (input.frame.nearest_m + input.frame.farthest_m);
    if (use_colour_) {
        state.gain = residual_model_.gain();
        state.offset = residual_model_.offset();
        if (input.frame.has_colour) state.alpha = residual_model_.alpha();
    }
    PredictAt(input, input.T_world_camera_starts.back(), state);
    ChooseStart(input, state);
    for (int level = config_.levels - 1; level >= 0 && !state.failed; --level) {
        PrepareLevel(input, level, state);
        if (!state.failed) RunLevel(level, state);
    }
    state.T_world_local = view_.T_world_camera;
    state.points = points_[0].valid();
    state.valid = state.step.valid;
    return Conclude(
        input, state, MakeResidualArguments(input.frame, camera_, points_[0], residuals_),
        [this](const ResidualArguments& a) { return sums_.SumResiduals(a); },
        config_.distance_scale_m, judge_, residual_model_);
}

// Predicts the view that the frame is aligned with. The camera's pose is estimated in its frame.
void IcpTracker::PredictAt(const TrackInput& input, const Eigen::Isometry3d& T_world_view,
                           State& state) {
    constexpr float kNear_m = 0.1f, kMargin_m = 0.5f;
    const ModelRange range{std::max(kNear_m, 0.7f * input.frame.nearest_m - kMargin_m),
                           1.2f * input.frame.farthest_m + kMargin_m,
                           static_cast<float>(config_.distance_gate_m)};
    const PinholeCamera camera = camera_.Every(finest_step_px_);
    state.T_local_camera.setIdentity();
    const Eigen::Isometry3d T_world_camera = Normalised(T_world_view);
    if (predictor_ == nullptr)
        return sums_.Predict(input.map, camera, T_world_camera, range, config_.levels, view_,
                             model_);
    predictor_->Predict(input.map, camera, T_world_camera, range.near_m, range.far_m, view_);
    BuildIcpModel(view_, config_.levels, range.jump_m, model_);
    sums_.SetModel(model_);
}

// Chooses the start that fits best on the coarsest level. If it lies far from the predicted view,
// predicts the view again, because it would show another part of the map.
void IcpTracker::ChooseStart(const TrackInput& input, State& state) {
    const auto& starts = input.T_world_camera_starts;
    if (starts.size() < 2) return;
    PrepareLevel(input, config_.levels - 1, state);
    if (state.failed) return;
    const FramePoints& points = points_.back();
    const Eigen::Isometry3d T_view_world = view_.T_world_camera.inverse();
    double best = std::numeric_limits<double>::infinity();
    Eigen::Isometry3d T_best = state.T_local_camera;
    for (const Eigen::Isometry3d& T_world_camera : starts) {
        state.T_local_camera = Normalised(T_view_world * T_world_camera);
        const PoseSums sums = SumAt(points, Compare::kWithNothing, state);
        const double misfit =
            Misfit(sums, sums[SumLayout::kInliers], static_cast<double>(points.valid()),
                   config_.distance_scale_m, state.alpha);
        if (misfit >= best) continue;
        best = misfit;
        T_best = state.T_local_camera;
    }
    state.T_local_camera = T_best;
    if (state.T_local_camera.translation().norm() < kAnotherView_m &&
        RotationAngle(state.T_local_camera, Eigen::Isometry3d::Identity()) < kAnotherView_rad)
        return;
    PredictAt(input, view_.T_world_camera * state.T_local_camera, state);
}

void IcpTracker::PrepareLevel(const TrackInput& input, int level, State& state) {
    FramePoints& points = points_[static_cast<std::size_t>(level)];
    state.motion = use_colour_ ? residual_model_.Timed(input.motion) : input.motion;
    if (input.since_last_s > 0)  // velocity since the last frame, at the present estimate
        state.motion.twist_per_s = Se3Log(input.T_world_camera_last.inverse() *
                                          view_.T_world_camera * state.T_local_camera) /
                                   input.since_last_s;
    const int step = finest_step_px_ << level;
    const DepthWeight weight{config_.noise_depth_m, input.nearest_m};
    PointArguments points_arguments =
        MakePointArguments(input.frame, camera_, state.motion, step, weight, state.alpha > 0);
    points_arguments.normal_radius_px = config_.normal_radius_px;
    sums_.SetPoints(input.frame, points_arguments, level, points);
    state.failed = points.valid() == 0;
    IcpArguments& a = state.arguments;
    a = {};
    SetModel(model_[static_cast<std::size_t>(level)], a);
    a.x = points.x.data();
    a.y = points.y.data();
    a.z = points.z.data();
    a.normal_x = points.normal_x.data();
    a.normal_y = points.normal_y.data();
    a.normal_z = points.normal_z.data();
    a.intensity_of_point = points.intensity.data();
    a.weight = points.weight.data();
    a.distance_gate_m = static_cast<float>(config_.distance_gate_m);
    a.normal_gate_cosine = static_cast<float>(std::cos(config_.normal_gate_rad));
    a.distance_scale_m = static_cast<float>(config_.distance_scale_m);
    a.alpha = static_cast<float>(state.alpha);
    a.intensity_scale = static_cast<float>(residual_model_.config().intensity_scale);
    a.intensity_gate = static_cast<float>(kIntensityGateScales) * a.intensity_scale;
    a.band = input.map.config().band();
    for (PointResiduals* residuals : {&residuals_, &trial_residuals_})
        residuals->Resize(points.count());
}

// Sums at the state's pose and brightness.
PoseSums IcpTracker::SumAt(const FramePoints& points, Compare compare, State& state) {
    IcpArguments& a = state.arguments;
    SetPose(state.T_local_camera, a);
    a.gain = static_cast<float>(state.gain);
    a.offset = static_cast<float>(state.offset);
    a.distance_residual = trial_residuals_.distance_m.data();
    a.intensity_residual = trial_residuals_.intensity.data();
    for (std::size_t k = 0; k < 3; ++k) a.gradient[k] = trial_residuals_.gradient[k].data();
    a.distance_before = compare == Compare::kWithKept ? residuals_.distance_m.data() : nullptr;
    a.intensity_before = compare == Compare::kWithKept ? residuals_.intensity.data() : nullptr;
    ++state.iterations;
    return sums_.Sum(a, points.count());
}

// Levenberg-Marquardt on [D18] eq. 25.
void IcpTracker::RunLevel(int level, State& state) {
    const FramePoints& points = points_[static_cast<std::size_t>(level)];
    const int iterations = level == 0                    ? config_.fine_iterations
                           : level == config_.levels - 1 ? config_.coarse_iterations
                                                         : config_.middle_iterations;
    state.sums = SumAt(points, Compare::kWithNothing, state);
    KeepResiduals();
    if (level == 0 && state.alpha > 0 && residual_model_.TakesForShading(state.sums)) {
        state.rms_with_shading = IntensityRms(state.sums);
        sums_.RemoveShading(MakeShadingArguments(points_[0], residuals_, state.gain,
                                                 residual_model_.config().intensity_scale));
        state.sums = SumAt(points, Compare::kWithNothing, state);
        KeepResiduals();
    }
    SolverOptions& options = state.options;
    options.alpha = state.alpha;
    options.least_damping =
        LeastDamping(residual_model_.scales(), judge_.expected_within_m(), level);
    options.estimate_brightness = state.alpha > 0 && residual_model_.config().brightness;
    options.brightness_prior =
        residual_model_.config().brightness_prior * state.sums[SumLayout::kBrightness + 2];
    state.damping = {};
    const double tolerance = level == 0 ? 5e-5 : 2e-4;
    for (int i = 0; i < iterations; ++i) {
        options.damping = state.damping.damping();
        state.step = SolvePoseStep(state.sums, options, state.gain, state.offset,
                                   state.T_local_camera.translation(), state.scene_depth_m);
        state.failed = !state.step.valid;
        if (state.failed) return;
        if (state.step.predicted_decrease < kLeastFall * state.sums[SumLayout::kEnergy]) break;
        TakeStep(points, state);
        if (state.step.increment.head<3>().norm() < tolerance &&
            state.step.increment.tail<3>().norm() < tolerance)
            break;
    }
    state.T_local_camera = Normalised(state.T_local_camera);
}

// Takes the step only if the energy falls and at least half of the inliers remain.
void IcpTracker::TakeStep(const FramePoints& points, State& state) {
    State trial = state;
    trial.T_local_camera = Se3Exp(state.step.increment) * state.T_local_camera;
    trial.gain = std::clamp(state.gain + state.step.gain_change, 0.5, 2.0);
    trial.offset = std::clamp(state.offset + state.step.offset_change, -0.3, 0.3);
    trial.sums = SumAt(points, Compare::kWithKept, trial);
    const auto prior = [&](const State& s) {
        return state.alpha * state.options.brightness_prior *
               ((s.gain - 1) * (s.gain - 1) + s.offset * s.offset);
    };
    const double fall = trial.sums[SumLayout::kEnergyBefore] + prior(state) -
                        trial.sums[SumLayout::kEnergy] - prior(trial);
    const bool keeps_partners =
        2 * trial.sums[SumLayout::kInliers] >= state.sums[SumLayout::kInliers];
    const bool accept =
        state.damping.Accept(keeps_partners ? fall : 0.0, state.step.predicted_decrease);
    state.iterations = trial.iterations;
    if (!accept) return;
    trial.damping = state.damping;
    state = trial;
    KeepResiduals();
}

}  // namespace tessera
