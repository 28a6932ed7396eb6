#include "eval/ate.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/input_file.h"
#include "eval/alignment.h"

namespace tessera {

Result<AteResult> EvaluateAte(const std::vector<StampedPose>& reference,
                              const std::vector<StampedPose>& estimate, const AteOptions& options) {
    const Result<Alignment> alignment =
        AlignTrajectories(reference, estimate, options.max_difference_s);
    if (!alignment.ok()) return alignment.status();
    AteResult result;
    result.T_reference_estimate = alignment.value().T_reference_estimate;
    result.warning = alignment.value().warning;
    std::vector<double> errors;
    for (const PosePair& pair : alignment.value().pairs) {
        AteResult::Pair aligned;
        aligned.stamp_s = estimate[pair.estimate].stamp_s;
        aligned.p_reference = reference[pair.reference].T_world_camera.translation();
        aligned.p_estimate = result.T_reference_estimate *
                             Eigen::Vector3d(estimate[pair.estimate].T_world_camera.translation());
        aligned.error_m = (aligned.p_estimate - aligned.p_reference).norm();
        errors.push_back(aligned.error_m);
        result.pairs.push_back(aligned);
    }
    result.error_m = Summarise(std::move(errors));
    const auto poses = static_cast<double>(estimate.size());
    result.of_frames = options.frames && *options.frames > 0;
    result.tracked_fraction = result.of_frames
                                  ? std::min(1.0, poses / static_cast<double>(*options.frames))
                                  : static_cast<double>(result.pairs.size()) / poses;
    return result;
}

std::optional<std::int64_t> FramesOfRun(const std::string& trajectory_path) {
    const auto folder = std::filesystem::path(trajectory_path).parent_path();
    const Result<std::string> text = ReadWholeFile((folder / "timings.json").string(), 1 << 20);
    if (!text.ok()) return std::nullopt;
    const auto json = nlohmann::json::parse(text.value(), nullptr, /*allow_exceptions=*/false);
    if (!json.is_object()) return std::nullopt;
    const auto frames = json.find("frames");
    if (frames == json.end() || !frames->is_number_integer()) return std::nullopt;
    const auto count = frames->get<std::int64_t>();
    return count > 0 ? std::optional(count) : std::nullopt;
}

std::string AteJson(const AteResult& result) {
    const nlohmann::ordered_json json = {{"ate_rmse_m", result.error_m.rmse},
                                         {"ate_mean_m", result.error_m.mean},
                                         {"ate_median_m", result.error_m.median},
                                         {"ate_max_m", result.error_m.max},
                                         {"pairs", result.pairs.size()},
                                         {"tracked_fraction", result.tracked_fraction},
                                         {"alignment", "se3"}};
    return json.dump(2) + "\n";
}

}  // namespace tessera
