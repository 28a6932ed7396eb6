#include "tracking/conclude.h"

namespace tessera {
namespace {

// Enters what depends on the found pose, and which sums to compute.
void Enter(const FoundPose& found, const TrackResult& result, const ResidualModel& model,
           double distance_scale_m, ResidualArguments& a) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) a.rotation[3 * i + j] = found.T_local_camera.linear()(i, j);
    for (int i = 0; i < 6; ++i) a.twist_per_s[i] = found.motion.twist_per_s(i);
    a.colour_delay_s = found.motion.colour_delay_s;
    a.colour_readout_s = found.motion.colour_readout_s;
    a.gain = found.gain;
    a.residual_scale = result.intensity_rms;
    a.distance_scale_m = distance_scale_m;
    a.intensity_scale = model.config().intensity_scale;
    a.has_intensity = found.alpha > 0;
    a.wants_shutter = a.has_intensity && model.WantsShutter(found.motion, result.intensity_rms);
}

}  // namespace

TrackResult Conclude(const TrackInput& input, const FoundPose& found, ResidualArguments a,
                     const std::function<ResidualSums(const ResidualArguments&)>& sum,
                     double distance_scale_m, const TrackJudge& judge, ResidualModel& model) {
    TrackResult result;
    result.motion = found.motion;
    result.alpha = found.alpha;
    result.gain = found.gain;
    result.offset = found.offset;
    result.iterations = found.iterations;
    result.T_world_camera = Normalised(found.T_world_local * found.T_local_camera);
    if (!judge.Fits(found.points, found.valid ? found.sums : PoseSums(), result)) return result;

    Enter(found, result, model, distance_scale_m, a);
    const ResidualSums sums = sum(a);
    // Before anything is learnt from it.
    result.colour_rejected =
        input.place_known && a.has_intensity && model.Contradicts(sums, result.intensity_rms);
    if (result.colour_rejected) {
        result.status = TrackStatus::kLost;
        return result;
    }

    const Eigen::Vector3d camera_local = found.T_local_camera.translation();
    const PoseTerm distances =
        DistanceTerm(found.sums).Normalised(camera_local, found.scene_depth_m);
    const PoseTerm intensities = IntensityTerm(found.sums, found.options, found.gain, found.offset)
                                     .Normalised(camera_local, found.scene_depth_m);
    model.LearnScales(
        {a, sums, distances, intensities, found.scene_depth_m, input.map.config().voxel_size_m});
    const Matrix6d information =
        PoseInformation(sums, intensities, model.scales(), found.scene_depth_m);
    const PoseUncertainty knowledge = ComputeUncertainty(information, judge.expected_within_m(),
                                                         camera_local, found.scene_depth_m);
    result.uncertainty_m = knowledge.uncertainty_m;

    // The prealignment is the prior, unless it is fooled: a hand that covers the view looks like an
    // image that has jumped.
    const Eigen::Isometry3d &T_world_moved = input.T_world_camera_starts.front(),
                            &T_world_aligned = input.T_world_camera_starts.back();
    const Eigen::Isometry3d& T_world_expected =
        judge.Follows(T_world_moved, T_world_aligned) ? T_world_aligned : T_world_moved;
    const Eigen::Isometry3d T_local_expected = found.T_world_local.inverse() * T_world_expected;
    const Vector6d astray =
        knowledge.open * Se3Log(found.T_local_camera * T_local_expected.inverse());
    result.T_world_camera =
        Normalised(found.T_world_local * Se3Exp(-astray) * found.T_local_camera);
    judge.Judge(input, result);
    if (result.status != TrackStatus::kLost && result.alpha > 0)
        model.LearnColour(result, sums, found.rms_with_shading);
    return result;
}

}  // namespace tessera
