#include "run/finish_run.h"

#include <cmath>
#include <filesystem>
#include <unordered_map>

#include "export/level.h"
#include "io/frame_reader.h"
#include "run/open_source.h"
#include "run/run_source.h"
#include "run/scanned.h"
#include "scan/scan_source.h"

namespace tessera {
namespace {

struct Input {
    Scanned scanned;
    std::unique_ptr<FrameSource> frames;
};

Result<Input> FromScan(const std::string& path) {
    Result<std::unique_ptr<FrameSource>> frames = ScanSource::Open(path);
    if (!frames.ok()) return frames.status();
    Result<Scanned> scanned = ReadScanFile(path);
    if (!scanned.ok()) return scanned.status();
    return Input{std::move(scanned.value()), std::move(frames.value())};
}

Result<Input> FromRun(const std::string& folder, const std::string& source) {
    Result<Scanned> scanned = ReadRunFolder(folder);
    if (!scanned.ok()) return scanned.status();
    const Result<RunRecord> record = ReadRunRecord(folder + "/run.json");
    if (!record.ok()) return record.status();
    Result<std::unique_ptr<FrameSource>> frames = OpenSourceOf(record.value(), source);
    if (frames.ok()) return Input{std::move(scanned.value()), std::move(frames.value())};
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

// Reads a source's frames twice, with their poses: some of them, then all. Owner thread only.
class FinishFrameReader {
  public:
    FinishFrameReader(std::unique_ptr<FrameSource> source, const std::vector<StampedPose>& path)
        : info_(source->info()), source_(std::move(source)), poses_(path) {
        stride_ = (info_.frame_count + FrameEvidence::kMostFrames - 1) / FrameEvidence::kMostFrames;
    }

    const SourceInfo& info() const { return info_; }
    // Why reading has failed.
    const Status& status() const { return failed_; }
    // How many of all frames have colour and a pose.
    std::int64_t posed() const { return posed_; }

    // A source that cannot go back to its start, or whose length is not known, has no sample.
    bool NextOfSample(Frame& frame) {
        while (next_ < info_.frame_count) {
            if (!source_->Seek(next_)) return false;
            next_ += stride_;
            const ReadResult read = source_->Read(frame);
            if (read.status == ReadStatus::kSkip || read.status == ReadStatus::kWait) continue;
            if (read.status == ReadStatus::kError) failed_ = Status::Error(read.message);
            if (read.status != ReadStatus::kOk) return false;
            frame.T_world_camera = poses_.At(frame.stamp_s);
            return true;
        }
        return false;
    }

    // On a thread of its own, ahead.
    bool Next(Frame& frame) {
        if (!failed_.ok()) return false;
        if (source_) {
            if (next_ > 0 && !source_->Seek(0))
                failed_ = Status::Error(info_.name + ": cannot be read twice");
            if (!failed_.ok()) return false;
            reader_ = std::make_unique<FrameReader>(std::move(source_), FrameSelection{});
        }
        ReadResult read;
        do read = reader_->Next(frame);
        while (read.status == ReadStatus::kSkip || read.status == ReadStatus::kWait);
        if (read.status == ReadStatus::kError) failed_ = Status::Error(read.message);
        if (read.status != ReadStatus::kOk) return false;
        frame.T_world_camera = poses_.At(frame.stamp_s);
        posed_ += frame.T_world_camera.has_value() && !frame.colour.empty();
        return true;
    }

  private:
    const SourceInfo info_;
    std::unique_ptr<FrameSource> source_;  // until the reader has it
    std::unique_ptr<FrameReader> reader_;
    const Poses poses_;
    Status failed_;
    std::int64_t stride_ = 1, next_ = 0, posed_ = 0;
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
    FinishFrameReader reader(std::move(input.value().frames), scanned.path);
    const SourceInfo info = reader.info();
    const FinishFrames frames{[&](Frame& frame) { return reader.NextOfSample(frame); },
                              [&](Frame& frame) { return reader.Next(frame); }, info.frame_count};
    Result<FinishedModel> finished = FinishModel(std::move(scanned.mesh), info.camera, scanned.path,
                                                 frames, request.options, progress);
    if (!reader.status().ok()) return reader.status();
    if (!finished.ok()) return Status::Error(path + ": " + finished.message());
    if (reader.posed() == 0)
        return Status::Error(path + ": no frame of " + info.name +
                             " has both colour and a pose of the path; is it the run's source?");
    return finished;
}

}  // namespace tessera
