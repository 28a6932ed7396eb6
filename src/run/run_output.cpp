#include "run/run_output.h"

#include <algorithm>
#include <filesystem>

#include "io/detections_text.h"
#include "io/file.h"
#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "render/coarse_mesh.h"
#include "render/mesh_picture.h"
#include "run/earlier_run.h"
#include "run/run_report.h"
#include "semantics/detections_file.h"

namespace tessera {
namespace {

constexpr const char* kFramesHeader =
    "index,stamp_s,method,status,fused,degenerate,valid_depth_fraction,moving_fraction,known_"
    "fraction,inlier_fraction,distance_rms_m,"
    "intensity_rms,uncertainty_m,innovation_m,innovation_rad,alpha,gain,offset,iterations,new_"
    "blocks,fused_blocks,decode_ms,prepare_ms,"
    "track_ms,moving_ms,allocate_ms,fuse_ms,frame_ms,reason\n";

constexpr const char* kTrajectoryHeader =
    "# stamp_s tx ty tz qx qy qz qw: T_world_camera, metres\n";

std::string FrameLine(const FrameReport& r, double decode_ms, double frame_ms) {
    const TrackResult& t = r.track;
    std::string reason = t.reason;
    for (char& c : reason)
        if (c == '"' || c == '\n') c = '\'';
    return fmt::format(
        "{},{:.6f},{},{},{:d},{:d},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f},{:.5f},{:.3g},{:.5f},{:.5f},{"
        ":.4g},{:.4f},{:.4f},{},{},{},{:.3f},{:.3f},"
        "{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},\"{}\"\n",
        r.index, r.stamp_s, ToString(r.method), ToString(t.status), r.fused, t.degenerate,
        r.valid_depth_fraction, r.moving ? r.moving->moving_fraction() : 0.0, t.known_fraction,
        t.inlier_fraction, t.distance_rms_m, t.intensity_rms, t.uncertainty_m, t.innovation_m,
        t.innovation_rad, t.alpha, t.gain, t.offset, t.iterations, r.fusion.new_blocks,
        r.fusion.fused_blocks, decode_ms, r.prepare_ms, r.track_ms, r.moving_ms,
        r.fusion.allocate_ms, r.fusion.fuse_ms, frame_ms, reason);
}

// What was looked for, so that `tessera eval` can tell a class that was never found from one that
// nobody asked for.
std::string ClassesLine(const LabelClasses& classes) {
    std::string line = "# classes";
    for (int id = 1; id <= classes.count(); ++id)
        if (classes.CanBeFound(id)) line += " " + classes.name(id);
    return line + "\n";
}

std::string DetectionsHeader(const LabelClasses& classes) {
    std::string header =
        "# stamp class probability xmin ymin xmax ymax; '# frame STAMP' before each frame looked "
        "at\n" +
        ClassesLine(classes) + "# aliases";
    for (const auto& [from, to] : classes.aliases()) header += " " + from + "=" + to;
    return header + "\n";
}

}  // namespace

Result<std::unique_ptr<RunOutput>> RunOutput::Open(const RunRequest& request,
                                                   const RunConfig& config,
                                                   const SourceInfo& source,
                                                   const LabelClasses& classes) {
    if (Status status = PrepareOutputFolder(request.output_folder); !status.ok()) return status;
    std::unique_ptr<RunOutput> output(new RunOutput(request, config));
    RemoveEarlierRun(request.output_folder);
    RunSummary unfinished;
    unfinished.source = source;
    unfinished.exit = "unfinished";
    for (const Status& status :
         {WriteTextFile(output->Path("run.json"), RunJson(request, config, unfinished)),
          output->OpenGrowing("trajectory.txt", kTrajectoryHeader, output->trajectory_),
          output->OpenGrowing("frames.csv", kFramesHeader, output->frames_)})
        if (!status.ok()) return status;
    if (!request.labels.empty())
        if (Status status = output->BeginDetections(classes); !status.ok()) return status;
    return output;
}

Status RunOutput::BeginDetections(const LabelClasses& classes) {
    return OpenGrowing("detections.txt", DetectionsHeader(classes), detections_);
}

Status RunOutput::AddClasses(const LabelClasses& classes) {
    return detections_.Append(ClassesLine(classes));
}

Status RunOutput::OpenGrowing(const std::string& name, const std::string& header, Lines& lines) {
    lines.waiting.clear();
    if (Status status = lines.file.Open(Path(name)); !status.ok()) return status;
    return lines.Append(header);
}

Status RunOutput::Lines::Append(const std::string& lines) {
    waiting += lines;
    if (waiting.empty()) return Status::Ok();
    const Status status = file.Append(waiting);
    if (status.ok()) waiting.clear();
    return status;
}

Status RunOutput::AddFrame(const FrameReport& report, double decode_ms, double frame_ms) {
    Status path;
    if (report.tracked()) path = AddPath({{report.stamp_s, report.track.T_world_camera}});
    const Status frame = frames_.Append(FrameLine(report, decode_ms, frame_ms));
    return path.ok() ? frame : path;
}

Status RunOutput::AddDetections(const LabelReport& report, const LabelClasses& classes) {
    std::string lines = fmt::format("# frame {:.6f}\n", report.colour_stamp_s);
    for (const Detection& d : report.detections)
        lines += DetectionLine(report.colour_stamp_s, classes.name(d.class_id), d) + "\n";
    return detections_.Append(lines);
}

Status RunOutput::AddPath(const std::vector<StampedPose>& path) {
    std::string lines;
    for (const StampedPose& pose : path) {
        if (!path_.empty() && StartsAgain(last_stamp_s_, pose.stamp_s)) {
            if (Status status = trajectory_.Append(lines); !status.ok()) return status;
            if (Status status = BeginClock(); !status.ok()) return status;
            lines.clear();
        }
        last_stamp_s_ = pose.stamp_s;
        path_.push_back(pose.T_world_camera);
        lines += TrajectoryLine(pose) + "\n";
    }
    return trajectory_.Append(lines);
}

std::string RunOutput::EarlierPath(int clock) const {
    return NumberedPath(Path("trajectory.txt"), clock);
}

// The poses so far are from recordings with another clock: they move to a file of their own.
Status RunOutput::BeginClock() {
    std::error_code error;
    std::filesystem::rename(Path("trajectory.txt"), EarlierPath(++clocks_), error);
    if (error)
        return Status::Error(
            fmt::format("{}: cannot be written: {}", EarlierPath(clocks_), error.message()));
    return OpenGrowing("trajectory.txt", kTrajectoryHeader, trajectory_);
}

Status RunOutput::ReplacePath(const std::vector<StampedPose>& path) {
    constexpr double kSame_m = 1e-6;
    (void)trajectory_.Append("");
    const bool corrected =
        !std::ranges::equal(path, path_, [](const StampedPose& a, const Eigen::Isometry3d& b) {
            return (a.T_world_camera.translation() - b.translation()).norm() <= kSame_m;
        });
    if (corrected) {
        std::error_code ignored;  // without it, the path before the correction is not kept
        std::filesystem::copy_file(Path("trajectory.txt"), Path("trajectory_tracked.txt"),
                                   std::filesystem::copy_options::overwrite_existing, ignored);
    }
    path_.clear();
    for (const StampedPose& pose : path) path_.push_back(pose.T_world_camera);
    trajectory_.waiting.clear();
    return WriteTrajectory(Path("trajectory.txt"), path);
}

Status RunOutput::WritePicture(const TriangleMesh& mesh) const {
    if (mesh.triangles.empty()) return Status::Ok();
    const MeshView view = ChooseView(mesh, path_);
    RenderStyle style;
    style.path = path_;
    return WriteColourImage(Path("preview.png"),
                            RenderMesh(mesh, view.camera, view.T_world_camera, style));
}

Status RunOutput::WriteMesh(TriangleMesh mesh) const {
    // More triangles than the picture has pixels; ray casting needs about 100 bytes per triangle.
    constexpr std::size_t kMostInPicture = 2'000'000;
    const Status status = WritePly(Path("mesh.ply"), mesh);
    if (mesh.triangles.size() > kMostInPicture) mesh = CoarseMeshOf(mesh, kMostInPicture / 2);
    const Status picture = WritePicture(mesh);
    return status.ok() ? picture : status;
}

Status RunOutput::Finish(const RunSummary& summary) {
    Status first;
    const auto keep_first = [&](const Status& status) {
        if (first.ok()) first = status;
    };
    for (Lines* lines : {&trajectory_, &frames_, &detections_}) keep_first(lines->Append(""));
    keep_first(WriteTextFile(Path("timings.json"), TimingsJson(summary)));
    keep_first(WriteTextFile(
        Path("objects.json"),
        ObjectsJson(summary.labels ? summary.labels->objects : std::vector<MapObject>{})));
    keep_first(WriteTextFile(Path("run.json"), RunJson(request_, config_, summary)));
    return first;
}

}  // namespace tessera
