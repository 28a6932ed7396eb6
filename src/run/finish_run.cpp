#include "run/finish_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <unordered_map>

#include "export/level.h"
#include "finish/crop.h"
#include "finish/view_choice.h"
#include "io/chosen_frames.h"
#include "io/frame_reader.h"
#include "mapping/frame_kernels.h"
#include "run/open_source.h"
#include "run/run_source.h"
#include "run/scan_export.h"
#include "run/scanned.h"
#include "scan/scan_content.h"
#include "scan/scan_source.h"

namespace tessera {
namespace {

struct Input {
    Scanned scanned;
    std::unique_ptr<FrameSource> frames;
    PinholeCamera camera;  // with which the mesh was made
    double depth_readout_s = 0, colour_readout_s = 0;
    double disparity_offset_per_m = 0;  // by which the mesh's depth differs from the frames'
};

Result<Input> FromScan(const std::string& path) {
    Result<std::unique_ptr<FrameSource>> frames = ScanSource::Open(path);
    if (!frames.ok()) return frames.status();
    Result<Scanned> scanned = ReadScanFile(path);
    if (!scanned.ok()) return scanned.status();
    const Result<ScanMeta> meta = ReadScanMeta(path);
    if (!meta.ok()) return meta.status();
    const SourceInfo info = frames.value()->info();
    return Input{std::move(scanned.value()),
                 std::move(frames.value()),
                 info.camera,
                 info.depth_readout_s,
                 info.colour_readout_s,
                 ConfigOf(meta.value()).pipeline.frame.disparity_offset_per_m};
}

Result<Input> FromRun(const std::string& folder, const std::string& source) {
    Result<Scanned> scanned = ReadRunFolder(folder);
    if (!scanned.ok()) return scanned.status();
    const Result<RunRecord> record = ReadRunRecord(folder + "/run.json");
    if (!record.ok()) return record.status();
    Result<std::unique_ptr<FrameSource>> frames = OpenSourceOf(record.value(), source);
    if (frames.ok()) {
        const RunRecord& run = record.value();
        PinholeCamera camera = frames.value()->info().camera;
        if (run.refined_focal_px) {
            camera.fx = (*run.refined_focal_px)[0];
            camera.fy = (*run.refined_focal_px)[1];
        }
        return Input{
            std::move(scanned.value()), std::move(frames.value()), camera,
            run.depth_readout_s,        run.colour_readout_s,      run.disparity_offset_per_m};
    }
    if (!source.empty()) return frames.status();
    return Status::Error(folder + ": " + frames.message() + "; " +
                         (IsLiveSource(record.value().source_name)
                              ? "scan with --scan FILE.scan, and finish this file"
                              : "if it has moved, name it with --source"));
}

// Poses by time stamp, in the microseconds of a trajectory file.
class Poses {
  public:
    explicit Poses(const std::vector<StampedPose>& path) {
        for (const StampedPose& pose : path)
            poses_.try_emplace(Key(pose.stamp_s), pose.T_world_camera);
    }
    std::optional<Eigen::Isometry3d> At(double stamp_s) const {
        for (const std::int64_t near : {0, -1, 1})
            if (const auto found = poses_.find(Key(stamp_s) + near); found != poses_.end())
                return found->second;
        return std::nullopt;
    }

  private:
    static std::int64_t Key(double stamp_s) { return std::llround(1e6 * stamp_s); }
    std::unordered_map<std::int64_t, Eigen::Isometry3d> poses_;
};

// As PreparedFrame does it for the map.
void CorrectDisparity(float offset_per_m, DepthImage& depth_m) {
    if (offset_per_m == 0) return;
    for (float& z_m : std::span(depth_m.data(), depth_m.size())) {
        z_m = CorrectedDepth(z_m, offset_per_m);
        if (!std::isfinite(z_m) || z_m < 0) z_m = 0;
    }
}

// Reads frames of a source, with their poses, ahead on a thread of its own: first some of all, then
// those at given times. Their depth is corrected as the mesh's was. Owner thread only.
class FinishFrameReader {
  public:
    FinishFrameReader(std::unique_ptr<FrameSource> source, const std::vector<StampedPose>& path,
                      double disparity_offset_per_m)
        : info_(source->info()),
          source_(std::move(source)),
          poses_(path),
          disparity_offset_per_m_(static_cast<float>(disparity_offset_per_m)) {}

    const SourceInfo& info() const { return info_; }
    // Why reading has failed.
    const Status& status() const { return failed_; }
    // How many of the frames read have colour and a pose.
    std::int64_t posed() const { return posed_; }

    // A source that cannot go back to its start, or whose length is not known, has no sample.
    void BeginSample() {
        const std::int64_t stride =
            (info_.frame_count + FrameEvidence::kMostFrames - 1) / FrameEvidence::kMostFrames;
        std::vector<std::int64_t> indices;
        for (std::int64_t i = 0; i < info_.frame_count; i += stride) indices.push_back(i);
        Begin(std::move(indices));
    }

    // All frames, where the source does not know their time stamps.
    void BeginAt(const std::vector<double>& stamps_s) {
        reader_.reset();  // it has the source
        const std::vector<double> known_s = source_->Stamps_s();
        std::vector<std::int64_t> indices;
        for (std::size_t i = 0; i < known_s.size(); ++i)
            if (IsAt(known_s[i], stamps_s)) indices.push_back(static_cast<std::int64_t>(i));
        if (known_s.empty())
            for (std::int64_t i = 0; i < info_.frame_count; ++i) indices.push_back(i);
        if (info_.frame_count >= 0 && source_->Seek(0)) return Begin(std::move(indices));
        reader_ = std::make_unique<FrameReader>(std::move(source_), FrameSelection{});
    }

    bool Next(Frame& frame) {
        if (!failed_.ok() || !reader_) return false;
        ReadResult read;
        do read = reader_->Next(frame);
        while (read.status == ReadStatus::kSkip || read.status == ReadStatus::kWait);
        if (read.status == ReadStatus::kError) failed_ = Status::Error(read.message);
        if (read.status != ReadStatus::kOk) return false;
        CorrectDisparity(disparity_offset_per_m_, frame.depth_m);
        frame.T_world_camera = poses_.At(frame.stamp_s);
        posed_ += frame.T_world_camera.has_value() && !frame.colour.empty();
        return true;
    }

  private:
    static bool IsAt(double stamp_s, const std::vector<double>& stamps_s) {
        const auto near = std::ranges::lower_bound(stamps_s, stamp_s - ViewChoice::kSame_s);
        return near != stamps_s.end() && *near <= stamp_s + ViewChoice::kSame_s;
    }
    void Begin(std::vector<std::int64_t> indices) {
        reader_.reset();
        if (indices.empty()) return;
        reader_ = std::make_unique<FrameReader>(
            std::make_unique<ChosenFrames>(*source_, std::move(indices)), FrameSelection{});
    }

    const SourceInfo info_;
    std::unique_ptr<FrameSource> source_;  // null if the reader has it
    std::unique_ptr<FrameReader> reader_;  // of the source
    const Poses poses_;
    const float disparity_offset_per_m_;
    Status failed_;
    std::int64_t posed_ = 0;
};

}  // namespace

Result<FinishedModel> FinishRun(const FinishRequest& request, const FinishProgress& progress) {
    const std::string& path = request.input;
    std::error_code ignored;
    const bool is_run = std::filesystem::is_directory(path, ignored);
    if (!is_run && !request.source.empty())
        return Status::Error("--source: a scan file has its frames; leave --source out");
    Result<Input> input = is_run ? FromRun(path, request.source) : FromScan(path);
    if (!input.ok()) return input.status();
    Scanned& scanned = input.value().scanned;
    if (request.level) {
        const Result<Level> level = FindLevel(scanned.mesh, scanned.path);
        if (!level.ok()) return Status::Error("--level: " + path + ": " + level.message());
        MakeLevel(level.value(), scanned.mesh, scanned.path);
    }
    if (request.box_m)
        if (Status status = CropMesh(*request.box_m, scanned.mesh); !status.ok())
            return Status::Error("--box: " + path + ": " + status.message());
    // A scan's sessions may have clocks of their own.
    std::ranges::stable_sort(scanned.path, {}, &StampedPose::stamp_s);
    FinishFrameReader reader(std::move(input.value().frames), scanned.path,
                             input.value().disparity_offset_per_m);
    const SourceInfo info = reader.info();
    const NextPosedFrame next = [&](Frame& frame) { return reader.Next(frame); };
    reader.BeginSample();
    FinishFrames frames;
    frames.sample = next;
    frames.at = [&](const std::vector<double>& stamps_s) {
        reader.BeginAt(stamps_s);
        return next;
    };
    frames.count = info.frame_count;
    frames.depth_readout_s = input.value().depth_readout_s;
    frames.colour_readout_s = input.value().colour_readout_s;
    Result<FinishedModel> finished = FinishModel(std::move(scanned.mesh), input.value().camera,
                                                 scanned.path, frames, request.options, progress);
    if (!reader.status().ok()) return reader.status();
    if (!finished.ok()) return Status::Error(path + ": " + finished.message());
    if (reader.posed() == 0)
        return Status::Error(path + ": no frame of " + info.name +
                             " has both colour and a pose of the path; is it the run's source?");
    return finished;
}

}  // namespace tessera
