#include "report/run_record.h"

#include <nlohmann/json.hpp>

#include "core/input_file.h"

namespace tessera {
namespace {

using Json = nlohmann::ordered_json;

// Sets `value` if the key is there. A value of another type throws.
template <class T>
void Take(const Json& json, const char* key, T& value) {
    const auto found = json.find(key);
    if (found != json.end() && !found->is_null()) value = found->get<T>();
}

Json Child(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_object() ? *found : Json::object();
}

void TakeSource(const Json& json, RunRecord& record) {
    Take(json, "name", record.source_name);
    Take(json, "kind", record.source_kind);
    Take(json, "has_truth", record.has_truth);
    Take(json, "warnings", record.warnings);
    PinholeCamera camera{0, 0, 0, 0, 0, 0};
    const Json given = Child(json, "camera");
    Take(given, "width", camera.width);
    Take(given, "height", camera.height);
    Take(given, "fx", camera.fx);
    Take(given, "fy", camera.fy);
    Take(given, "cx", camera.cx);
    Take(given, "cy", camera.cy);
    if (CheckPlausible(camera).ok()) record.camera = camera;
}

// What the run found about its camera, as far as it was used.
void TakeCorrections(const Json& json, RunRecord& record) {
    const auto used = [&](const char* name) {
        bool is_used = false;
        const Json found = Child(json, name);
        Take(found, "used", is_used);
        return is_used ? found : Json::object();
    };
    Take(used("vignetting"), "share", record.vignetting);
    double given_s = 0, found_ms = 0;
    Take(Child(json, "configuration"), "source.colour_delay_s", given_s);
    Take(used("colour_delay"), "corrected_ms", found_ms);
    record.colour_delay_s = given_s + found_ms / 1000;
    double depth_ms = 0, colour_ms = 0;
    Take(Child(json, "shutter"), "depth_readout_ms", depth_ms);
    Take(Child(json, "shutter"), "colour_readout_ms", colour_ms);
    record.depth_readout_s = depth_ms / 1000;
    record.colour_readout_s = colour_ms / 1000;
    const Json shift = used("colour_shift");
    Take(shift, "x_px", record.colour_shift_px[0]);
    Take(shift, "y_px", record.colour_shift_px[1]);
    Take(Child(json, "configuration"), "frame.disparity_offset_per_m",
         record.disparity_offset_per_m);
    if (const Json refined = used("calibration"); !refined.empty()) {
        std::array<double, 2> focal_px = {0, 0};
        Take(refined, "fx", focal_px[0]);
        Take(refined, "fy", focal_px[1]);
        Take(refined, "disparity_offset_per_m", record.disparity_offset_per_m);
        if (focal_px[0] > 0 && focal_px[1] > 0) record.refined_focal_px = focal_px;
    }
    DepthDistortion depth;
    const Json errors = used("depth_distortion");
    Take(errors, "columns", depth.columns);
    Take(errors, "rows", depth.rows);
    Take(errors, "per_m", depth.per_m);
    if (depth.IsValid()) record.depth_distortion = std::move(depth);
}

void TakeAte(const Json& json, RunRecord& record) {
    if (json.empty()) return;
    RunRecord::Ate ate;
    Take(json, "ate_rmse_m", ate.rmse_m);
    Take(json, "ate_mean_m", ate.mean_m);
    Take(json, "ate_median_m", ate.median_m);
    Take(json, "ate_max_m", ate.max_m);
    Take(json, "pairs", ate.pairs);
    record.ate = ate;
}

RunRecord ToRecord(const Json& json) {
    RunRecord record;
    Take(json, "version", record.version);
    Take(json, "exit", record.exit);
    Take(json, "command_line", record.command_line);
    Take(json, "scan", record.scan);
    TakeSource(Child(json, "source"), record);
    TakeCorrections(json, record);
    TakeAte(Child(json, "ate"), record);
    const Json counts = Child(json, "counts"), configuration = Child(json, "configuration");
    for (const auto& [name, count] : counts.items())
        record.counts.emplace_back(name, count.get<std::int64_t>());
    for (const auto& [key, value] : configuration.items())
        record.configuration.emplace_back(
            key, value.is_string() ? value.get<std::string>() : value.dump());
    return record;
}

RunTimes ToTimes(const Json& json) {
    RunTimes times;
    Take(json, "wall_s", times.wall_s);
    Take(json, "fps", times.fps);
    Take(json, "peak_rss_mb", times.peak_rss_mb);
    double bytes = 0;
    Take(Child(json, "map"), "bytes", bytes);
    times.map_mb = bytes / 1e6;
    const Json stages = Child(json, "stages");
    for (const auto& [name, stage] : stages.items()) {
        RunTimes::Stage& s = times.stages.emplace_back();
        s.name = name;
        Take(stage, "mean_ms", s.mean_ms);
        Take(stage, "median_ms", s.median_ms);
        Take(stage, "p95_ms", s.p95_ms);
        Take(stage, "max_ms", s.max_ms);
    }
    return times;
}

// Reads a JSON object and converts it.
template <class T>
Result<T> ReadAs(const std::string& path, T (*convert)(const Json&)) {
    const Result<std::string> text = ReadWholeFile(path, std::size_t{1} << 26);
    if (!text.ok()) return text.status();
    const Json json = Json::parse(text.value(), nullptr, false);
    if (!json.is_object()) return Status::Error(path + ": is not a JSON object; repeat the run");
    try {
        return convert(json);
    } catch (const nlohmann::json::exception& error) {
        return Status::Error(fmt::format("{}: {}", path, Printable(error.what(), 200)));
    }
}

}  // namespace

std::optional<std::int64_t> RunRecord::Count(const std::string& name) const {
    for (const auto& [key, count] : counts)
        if (key == name) return count;
    return std::nullopt;
}

Result<RunRecord> ReadRunRecord(const std::string& path) { return ReadAs(path, ToRecord); }

Result<RunTimes> ReadRunTimes(const std::string& path) { return ReadAs(path, ToTimes); }

}  // namespace tessera
