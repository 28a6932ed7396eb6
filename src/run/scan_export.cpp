#include "run/scan_export.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "core/path_length.h"
#include "io/frame_recorder.h"
#include "scan/scan_source.h"
#include "semantics/label_mapper.h"
#include "system/mapping_stage.h"
#include "system/run_config.h"

namespace tessera {
namespace {

std::string MapText(const ScanContent& scan) {
    const BlockMap& map = *scan.map;
    Eigen::AlignedBox3i box;
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) continue;
        const BlockCoord c = map.coord(id);
        box.extend(Eigen::Vector3i(c.x, c.y, c.z));
    }
    const Eigen::Vector3d extent_m =
        box.isEmpty() ? Eigen::Vector3d::Zero()
                      : Eigen::Vector3d((box.sizes().array() + 1).cast<double>() * kBlockSide *
                                        scan.meta.voxel_size_m);
    return fmt::format(
        "map: {} blocks, {:.1f} x {:.1f} x {:.1f} m, voxels of {:g} m, truncation {:g} m{}\n",
        map.count(), extent_m.x(), extent_m.y(), extent_m.z(), scan.meta.voxel_size_m,
        scan.meta.truncation_m, scan.progress.labels ? ", with labels" : "");
}

// Writes each session's frames to a folder of its own, because a recording's stamps increase.
class SessionFolders {
  public:
    SessionFolders(std::string scan_path, std::string first, SourceInfo source)
        : scan_path_(std::move(scan_path)), first_(std::move(first)), source_(std::move(source)) {}

    // Returns why the frame is left out; empty if it is not.
    Result<std::string> Add(const Frame& frame) {
        if (recorder_ == nullptr || frame.stamp_s <= last_stamp_s_)
            if (Status status = Begin(frame); !status.ok()) return status;
        last_stamp_s_ = frame.stamp_s;
        if (std::string why = recorder_->WhyNot(frame); !why.empty()) return why;
        if (Status status = recorder_->Add(frame); !status.ok()) return status;
        return std::string();
    }
    // Returns where the later sessions are.
    Result<std::vector<std::string>> Finish() {
        if (recorder_ != nullptr)
            if (Status status = recorder_->Finish(); !status.ok()) return status;
        return std::move(notes_);
    }

  private:
    Status Begin(const Frame& frame) {
        std::string folder = first_;
        if (recorder_ != nullptr) {
            if (Status status = recorder_->Finish(); !status.ok()) return status;
            // "a/" becomes "a_2".
            folder = fmt::format(
                "{}_{}", (std::filesystem::path(first_) / "").parent_path().string(), ++session_);
            notes_.push_back(
                fmt::format("{}: the clock starts again at frame {}; the rest is in {}", scan_path_,
                            frame.index, folder));
        }
        Result<std::unique_ptr<FrameRecorder>> recorder = FrameRecorder::Create(folder, source_);
        if (!recorder.ok()) return recorder.status();
        recorder_ = std::move(recorder.value());
        return Status::Ok();
    }

    const std::string scan_path_, first_;
    const SourceInfo source_;
    std::unique_ptr<FrameRecorder> recorder_;
    std::vector<std::string> notes_;
    double last_stamp_s_ = 0;
    int session_ = 1;
};

Status OtherClasses() {
    return Status::Error("the scan's labels do not match the classes in its configuration");
}

// "all" stands for the classes that the scan has, under the names that they have now.
Result<LabelClasses> ClassesOf(const ScanContent& scan, LabelConfig config) {
    StateReader state(scan.labels);
    const auto names = LabelMapper::LoadClassNames(state);
    if (!names) return OtherClasses();
    config.aliases.clear();
    Result<LabelClasses> classes = LabelClasses::Make(config, *names);
    if (!classes.ok()) return OtherClasses();
    return classes;
}

}  // namespace

RunConfig ConfigOf(const ScanMeta& meta) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    // Keys of another version that cannot be read keep their defaults.
    static_cast<void>(parameters.LoadYaml(meta.configuration, "scan"));
    config.pipeline.map = {.voxel_size_m = meta.voxel_size_m,
                           .truncation_m = meta.truncation_m,
                           .band_per_m = meta.band_per_m};
    return config;
}

Result<TriangleMesh> MeshOfScan(ScanContent& scan) {
    const RunConfig config = ConfigOf(scan.meta);
    MappingStage mapping(config.pipeline, config.meshing, scan.meta.camera);
    if (scan.progress.labels) {
        Result<LabelClasses> classes = ClassesOf(scan, config.labels);
        if (!classes.ok()) return classes.status();
        mapping.EnableLabels(config.labels, std::move(classes.value()));
        StateReader labels(scan.labels);
        if (!mapping.LoadLabels(labels)) return OtherClasses();
    }
    mapping.Resume(std::move(scan.map), scan.progress.fused_frames);
    return mapping.TakeMesh();
}

Result<std::vector<std::string>> ExportFrames(const std::string& scan_path,
                                              const std::string& folder) {
    Result<std::unique_ptr<FrameSource>> source = ScanSource::Open(scan_path);
    if (!source.ok()) return source.status();
    SessionFolders folders(scan_path, folder, source.value()->info());
    std::int64_t left_out = 0;
    std::string first_reason;
    const auto leave_out = [&](const std::string& why) {
        if (left_out++ == 0) first_reason = why;
    };
    Frame frame;
    ReadResult read;
    while ((read = source.value()->Read(frame)).status != ReadStatus::kEnd) {
        if (read.status == ReadStatus::kOk) {
            const Result<std::string> why_not = folders.Add(frame);
            if (!why_not.ok()) return why_not.status();
            if (!why_not.value().empty()) leave_out(why_not.value());
        } else if (read.status == ReadStatus::kSkip) {
            leave_out(read.message);
        } else {
            return Status::Error(read.message);
        }
    }
    Result<std::vector<std::string>> notes = folders.Finish();
    if (!notes.ok()) return notes;
    if (left_out == source.value()->info().frame_count)
        return Status::Error(first_reason + "; no frame can be exported");
    if (left_out > 0)
        notes.value().push_back(fmt::format("{} of {} frames are left out ({})", left_out,
                                            source.value()->info().frame_count, first_reason));
    return notes;
}

Result<std::string> DescribeScan(const std::string& path) {
    Result<std::unique_ptr<ScanFile>> opened = ScanFile::OpenToRead(path);
    if (!opened.ok()) return opened.status();
    ScanFile& file = *opened.value();
    Result<ScanContent> content = ReadScan(file, {});
    if (!content.ok()) return content.status();
    content.value().RemoveHiddenBlocks();
    const ScanContent& scan = content.value();
    const PinholeCamera& c = scan.meta.camera;
    std::string text = fmt::format(
        "{}: scan, format version {}, created by tessera {}, {}\n", path, file.version(),
        scan.meta.program, scan.finished ? "complete" : "unfinished: continue it with --resume");
    text += fmt::format("source: {} ({})\n", scan.meta.source_name, scan.meta.source_kind);
    text += fmt::format("camera: {} x {}, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f} px\n", c.width,
                        c.height, c.fx, c.fy, c.cx, c.cy);
    const std::vector<StampedPose> poses = scan.Path();
    text += fmt::format("path: {} frames, {} tracked, {:.2f} m", scan.path.size(), poses.size(),
                        PathLength_m(poses));
    if (!scan.path.empty())
        text += fmt::format(", {:.6f} to {:.6f} s", scan.path.front().stamp_s,
                            scan.path.back().stamp_s);
    const auto hidden = std::ranges::count_if(scan.path, &PathRecord::tracked) - std::ssize(poses);
    if (hidden > 0)
        text += fmt::format("\nframes that nothing joins with the rest, not shown: {}", hidden);
    text += "\n" + MapText(scan);
    if (scan.meta.loops)
        text += fmt::format("loop closure: {} keyframes, {} loops\n", scan.keyframes.size(),
                            scan.loops.loops);
    for (const ScanTable table : kScanTables) {
        std::size_t bytes = 0, rows = 0;
        Status read = file.Read(table, [&](const ScanRow& row) {
            bytes += row.data.size();
            ++rows;
            return Status::Ok();
        });
        if (!read.ok()) return read;
        if (rows > 0)
            text += fmt::format("  {:<10} {:>8} rows {:>10.2f} MB\n", ToString(table), rows,
                                static_cast<double>(bytes) / 1e6);
    }
    std::error_code ignored;
    text += fmt::format("file: {:.2f} MB, no errors found\n",
                        static_cast<double>(std::filesystem::file_size(path, ignored)) / 1e6);
    return text;
}

}  // namespace tessera
