#include "run/run_report.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace tessera {
namespace {

using Json = nlohmann::ordered_json;

// Paths and messages may not be valid UTF-8.
std::string Dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json ConfigurationJson(RunConfig& config) {
    ConfigParameters parameters;
    config.Describe(parameters);
    Json json = Json::object();
    for (const ConfigParameters::Parameter& parameter : parameters.parameters()) {
        const std::string text = parameter.get();
        Json value = parameter.is_text ? Json(text) : Json::parse(text, nullptr, false);
        json[parameter.key] = value.is_discarded() ? Json(text) : value;
    }
    return json;
}

Json SourceJson(const SourceInfo& source) {
    const PinholeCamera& c = source.camera;
    return {{"name", source.name},
            {"kind", source.kind},
            {"camera",
             {{"width", c.width},
              {"height", c.height},
              {"fx", c.fx},
              {"fy", c.fy},
              {"cx", c.cx},
              {"cy", c.cy}}},
            {"frames", source.frame_count},
            {"fps", source.fps},
            {"rectified", source.rectified},
            {"has_truth", source.has_truth},
            {"notes", source.notes},
            {"warnings", source.warnings}};
}

// The estimated focal lengths, used or not. Those under "source" are the given ones.
Json CalibrationJson(const PinholeCamera& given, double offset_before_per_m,
                     const CalibrationReport& report) {
    const PinholeCamera found = Corrected(given, report.calibration);
    return {
        {"used", report.shown},
        {"fx", found.fx},
        {"fy", found.fy},
        {"focal_sigma", report.focal_sigma},
        {"disparity_offset_per_m", offset_before_per_m + report.calibration.disparity_offset_per_m},
        {"disparity_offset_sigma_per_m", report.offset_sigma_per_m},
        {"points", report.points},
        {"apart_before_mm", 1000 * report.rms_before_m},
        {"apart_mm", 1000 * report.rms_after_m}};
}

// The estimate from the recording. "source" has the camera that was used.
Json CameraJson(const CameraReport& report) {
    const CameraEstimate& e = report.estimate;
    return {
        {"known", report.known},
        {"used", report.used},
        {"given", {{"fx", e.given.fx}, {"fy", e.given.fy}, {"cx", e.given.cx}, {"cy", e.given.cy}}},
        {"found", {{"fx", e.found.fx}, {"fy", e.found.fy}, {"cx", e.found.cx}, {"cy", e.found.cy}}},
        {"sigma_px",
         {{"fx", e.focal_sigma_px}, {"cx", e.centre_x_sigma_px}, {"cy", e.centre_y_sigma_px}}},
        {"readout_ms", 1000 * e.readout_s},
        {"readout_sigma_ms", 1000 * e.readout_sigma_s},
        {"misfit_given", e.misfit_given},
        {"misfit_found", e.misfit_found},
        {"pairs", e.pairs}};
}

Json ColourShiftJson(const ColourShift& shift) {
    return {{"known", shift.known},
            {"used", shift.used},
            {"x_px", shift.x_px},
            {"y_px", shift.y_px},
            {"sigma_px", {{"x", shift.sigma_x_px}, {"y", shift.sigma_y_px}}},
            {"frames", shift.frames}};
}

Json DepthDistortionJson(const DepthDistortionEstimate& e) {
    return {{"used", e.used},
            {"rms_per_m", e.rms_per_m},
            {"sigma_per_m", e.sigma_per_m},
            {"noise_per_m", e.noise_per_m},
            {"pairs", e.pairs},
            {"columns", e.found.columns},
            {"rows", e.found.rows},
            {"per_m", e.found.per_m}};
}

Json ColourDelayJson(const ColourDelay& delay) {
    return {{"used", delay.used},
            {"delay_ms", 1000 * delay.delay_s},
            {"corrected_ms", 1000 * (delay.used ? delay.certain_s() : 0)},
            {"delay_sigma_ms", 1000 * delay.delay_sigma_s},
            {"readout_difference_ms", 1000 * delay.readout_s},
            {"depth_rolls", delay.depth_rolls}};
}

}  // namespace

std::string ScanWrittenBy(const RunRequest& request) {
    if (request.scan_file.empty() || request.localise_only) return "";
    std::error_code ignored;
    return std::filesystem::absolute(request.scan_file, ignored).lexically_normal().string();
}

std::string TimingsJson(const RunSummary& summary) {
    Json stages = Json::object();
    for (const auto& [stage, s] : summary.stages)
        stages[stage] = {{"mean_ms", s.mean_ms},
                         {"median_ms", s.median_ms},
                         {"p95_ms", s.p95_ms},
                         {"max_ms", s.max_ms}};
    return Dump({{"frames", summary.counts.frames},
                 {"tracked", summary.counts.tracked},
                 {"wall_s", summary.wall_s},
                 {"cpu_s", summary.cpu_s},
                 {"fps", summary.fps},
                 {"peak_rss_mb", summary.peak_rss_mb},
                 {"stages", stages},
                 {"map",
                  {{"blocks", summary.map.blocks},
                   {"bytes", summary.map.bytes},
                   {"bytes_per_voxel", summary.map.bytes_per_voxel}}}});
}

std::string RunJson(const RunRequest& request, RunConfig config, const RunSummary& summary) {
    const RunCounts& n = summary.counts;
    Json json = {{"version", TESSERA_VERSION},
                 {"command_line", request.command_line},
                 {"exit", summary.exit},
                 {"source", SourceJson(summary.source)},
                 {"selection",
                  {{"start", request.selection.start},
                   {"frames", request.selection.count},
                   {"stride", request.selection.stride}}},
                 {"poses", request.poses_file},
                 {"scan", ScanWrittenBy(request)},
                 {"counts",
                  {{"frames", n.frames},
                   {"tracked", n.tracked},
                   {"fused", n.fused},
                   {"poor", n.poor},
                   {"lost", n.lost},
                   {"skipped", n.skipped},
                   {"dropped", n.dropped},
                   {"unfused", n.unfused},
                   {"degenerate", n.degenerate}}},
                 {"ate", nullptr}};
    if (summary.labels)
        json["labels"] = {
            {"detector", summary.detector},
            {"frames", summary.labels->frames},
            {"frames_per_s", summary.wall_s > 0
                                 ? static_cast<double>(summary.labels->frames) / summary.wall_s
                                 : 0.0},
            {"detections", summary.labels->detections},
            {"settled_voxels", summary.labels->settled},
            {"settled_flips", summary.labels->flips},
            {"objects", summary.labels->objects.size()}};
    if (summary.calibration)
        json["calibration"] =
            CalibrationJson(summary.source.camera, config.pipeline.frame.disparity_offset_per_m,
                            *summary.calibration);
    const CameraFindings& found = summary.found;
    if (found.camera) json["camera_estimate"] = CameraJson(*found.camera);
    if (const auto& v = found.vignetting)
        json["vignetting"] = {{"used", v->used}, {"share", v->share}, {"sigma", v->sigma}};
    if (found.colour_shift) json["colour_shift"] = ColourShiftJson(*found.colour_shift);
    if (found.colour_delay) json["colour_delay"] = ColourDelayJson(*found.colour_delay);
    if (found.depth_distortion)
        json["depth_distortion"] = DepthDistortionJson(*found.depth_distortion);
    json["shutter"] = {{"depth_readout_ms", 1000 * summary.depth_readout_s},
                       {"colour_readout_ms", 1000 * summary.colour_readout_s}};
    if (summary.ate) json["ate"] = Json::parse(AteJson(*summary.ate), nullptr, false);
    json["configuration"] = ConfigurationJson(config);
    return Dump(json);
}

}  // namespace tessera
