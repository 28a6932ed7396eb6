#include "system/scan_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace tessera {
namespace {

struct ScanKey {
    const char* key;
    std::string value;
};

std::vector<ScanKey> KeysOf(const ScanMeta& meta) {
    return {{"mapping.voxel_size_m", fmt::format("{}", meta.voxel_size_m)},
            {"mapping.truncation_m", fmt::format("{}", meta.truncation_m)},
            {"mapping.band_per_m", fmt::format("{}", meta.band_per_m)},
            {"loops.enabled", meta.loops ? "true" : "false"}};
}

// Names the values that differ, with all their digits.
Status CheckCamera(const std::string& path, const ScanMeta& meta, const SourceInfo& source) {
    const PinholeCamera &was = meta.camera, &is = source.camera;
    if (was == is) return Status::Ok();
    std::string of_scan, of_source;
    const auto compare = [&](const char* name, auto a, auto b) {
        if (a == b) return;
        of_scan += fmt::format("{}{} {}", of_scan.empty() ? "" : ", ", name, a);
        of_source += fmt::format("{}{} {}", of_source.empty() ? "" : ", ", name, b);
    };
    compare("width", was.width, is.width);
    compare("height", was.height, is.height);
    compare("fx", was.fx, is.fx);
    compare("fy", was.fy, is.fy);
    compare("cx", was.cx, is.cx);
    compare("cy", was.cy, is.cy);
    return Status::Error(
        fmt::format("{}: was made with a camera of {}, but {} has {}; use the same camera, or "
                    "start another scan",
                    path, of_scan, source.name, of_source));
}

// A recording may be named in several ways: d, d/, ./d or by its whole path.
bool IsSameSource(const std::string& a, const std::string& b) {
    std::error_code no_file;
    return a == b || std::filesystem::equivalent(a, b, no_file);
}

}  // namespace

Status TakeScanKeys(const std::string& path, ConfigParameters& parameters) {
    const Result<ScanMeta> meta = ReadScanMeta(path);
    if (!meta.ok()) return meta.status();
    for (const ScanKey& key : KeysOf(meta.value()))
        if (Status status = parameters.Set(key.key, key.value); !status.ok())
            return DamagedScan(path, "meta: " + status.message());
    return Status::Ok();
}

Status CheckScanKeys(const std::string& path, ConfigParameters& parameters) {
    const Result<ScanMeta> meta = ReadScanMeta(path);
    if (!meta.ok()) return meta.status();
    for (const ScanKey& key : KeysOf(meta.value())) {
        const auto found =
            std::ranges::find(parameters.parameters(), key.key, &ConfigParameters::Parameter::key);
        const std::string wanted = found->get();
        static_cast<void>(parameters.Set(key.key, key.value));
        if (found->get() != wanted)
            return Status::Error(
                fmt::format("{}: {} was requested, but {} was scanned with {}; leave the key out, "
                            "or start another scan",
                            key.key, wanted, path, found->get()));
    }
    return Status::Ok();
}

Result<ScanPlan> BeginScan(const std::string& path, const SourceInfo& source, RunConfig config) {
    ScanMeta meta;
    meta.program = TESSERA_VERSION;
    meta.source_name = source.name;
    meta.source_kind = source.kind;
    meta.camera = source.camera;
    meta.depth_units_per_m = source.depth_units_per_m;
    meta.voxel_size_m = config.pipeline.map.voxel_size_m;
    meta.truncation_m = config.pipeline.map.truncation_m;
    meta.band_per_m = config.pipeline.map.band_per_m;
    meta.loops = config.loops.enabled;
    ConfigParameters parameters;
    config.Describe(parameters);
    meta.configuration = parameters.ToYaml();
    Result<std::unique_ptr<ScanFile>> file = ScanFile::Create(path, meta.Encode());
    if (!file.ok()) return file.status();
    ScanPlan plan;
    plan.file = std::move(file.value());
    plan.depth_units_per_m = meta.depth_units_per_m;
    return plan;
}

Result<ScanPlan> ResumeScan(const std::string& path, const SourceInfo& source,
                            const RunConfig& config, bool labels) {
    Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToWrite(path);
    if (!file.ok()) return file.status();
    Result<ScanContent> content =
        ReadScan(*file.value(), {.map = true, .frames = config.loops.enabled, .labels = labels});
    if (!content.ok()) return content.status();
    ScanContent& scan = content.value();
    if (Status status = CheckCamera(path, scan.meta, source); !status.ok()) return status;
    if (scan.progress.labels && !labels)
        return Status::Error(path +
                             ": has labels, which would be lost; give the same --labels as when "
                             "the scan was created");
    ScanPlan plan;
    plan.file = std::move(file.value());
    plan.depth_units_per_m = scan.meta.depth_units_per_m;
    plan.source_name = source.name;
    plan.resumed = std::move(scan);
    return plan;
}

Result<ScanPlan> OpenToLocalise(const std::string& path, const SourceInfo& source,
                                const RunConfig& config) {
    Result<ScanContent> content = ReadScan(path, {.map = true, .frames = config.loops.enabled});
    if (!content.ok()) return content.status();
    ScanContent& scan = content.value();
    if (Status status = CheckCamera(path, scan.meta, source); !status.ok()) return status;
    if (!scan.LastPose())
        return Status::Error(path + ": nothing was tracked in this scan; give a scan with a map");
    ScanPlan plan;
    plan.depth_units_per_m = scan.meta.depth_units_per_m;
    plan.resumed = std::move(scan);
    return plan;
}

FrameSelection RestOf(const FrameSelection& selection, const SourceInfo& source,
                      const ScanContent& resumed) {
    const std::int64_t last = resumed.progress.last_index;
    if (source.live || !IsSameSource(source.name, resumed.source_name) || last < selection.start ||
        selection.stride < 1)
        return selection;
    FrameSelection rest = selection;
    const std::int64_t done = (last - selection.start) / selection.stride + 1;
    rest.start = selection.start + done * selection.stride;
    if (selection.count >= 0) rest.count = std::max<std::int64_t>(0, selection.count - done);
    const bool behind_the_end = source.frame_count >= 0 && rest.start >= source.frame_count;
    if (behind_the_end || rest.count == 0) return {0, 0, 1};
    return rest;
}

}  // namespace tessera
