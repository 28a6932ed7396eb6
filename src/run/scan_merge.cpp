#include "run/scan_merge.h"

#include <fmt/format.h>

#include <filesystem>
#include <numeric>

#include "io/file.h"
#include "optimize/session_join.h"
#include "run/scan_export.h"
#include "scan/scan_writer.h"
#include "system/loop_journal.h"
#include "system/loop_stage.h"

namespace tessera {
namespace {

struct Part {
    std::unique_ptr<ScanFile> file;
    ScanContent content;
};

Result<Part> Open(const std::string& path) {
    Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToRead(path);
    if (!file.ok()) return file.status();
    Result<ScanContent> content = ReadScan(*file.value(), {.map = false, .frames = true});
    if (!content.ok()) return content.status();
    Part part{std::move(file.value()), std::move(content.value())};
    if (!part.content.meta.loops || part.content.keyframes.empty())
        return Status::Error(path +
                             ": has no keyframes, in which a common place is looked for; scan "
                             "with --loop-closure on");
    if (part.content.progress.labels)
        return Status::Error(path + ": has labels, which merging would lose");
    return part;
}

Status CheckTogether(const std::string& a_path, const ScanMeta& a, const std::string& b_path,
                     const ScanMeta& b) {
    const auto differ = [&](const char* what) {
        return Status::Error(
            fmt::format("{} and {}: differ in {}; only scans with the same can be "
                        "merged",
                        a_path, b_path, what));
    };
    if (!(a.camera == b.camera)) return differ("the camera");
    if (a.depth_units_per_m != b.depth_units_per_m) return differ("the depth images' scale");
    if (a.voxel_size_m != b.voxel_size_m) return differ("mapping.voxel_size_m");
    if (a.truncation_m != b.truncation_m) return differ("mapping.truncation_m");
    return Status::Ok();
}

// The path and its frames' numbers of b follow those of a.
struct Offsets {
    std::int64_t path = 0, ordinal = 0;
    int keyframe = 0;
};

Status CopyFrames(Part& part, const Offsets& by, ScanFile& out) {
    return part.file->Read(ScanTable::kFrames, [&](const ScanRow& row) {
        FrameRecord record;
        if (!record.Decode(row.data))
            return DamagedScan(part.file->path(), fmt::format("frames {}", row.key));
        record.stored.keyframe += by.keyframe;
        record.stored.ordinal += by.ordinal;
        const Result<Bytes> bytes = record.Encode();
        if (!bytes.ok()) return bytes.status();
        out.Put(ScanTable::kFrames, row.key + by.path, bytes.value());
        return out.error();
    });
}

void AddPath(const ScanContent& scan, const Offsets& by, const Eigen::Isometry3d& T_world_scan,
             ScanCheckpoint& checkpoint) {
    std::int64_t number = by.path;
    for (PathRecord record : scan.path) {
        if (record.keyframe >= 0)
            record.keyframe += by.keyframe;
        else if (record.tracked())
            record.T_reference_camera = Normalised(T_world_scan * record.T_reference_camera);
        checkpoint.path.emplace_back(number++, record);
    }
}

ScanProgress Sum(const ScanProgress& a, const ScanProgress& b) {
    ScanProgress sum = b;
    sum.frames += a.frames;
    sum.fused_frames += a.fused_frames;
    sum.labelled_frames += a.labelled_frames;
    return sum;
}

void AddClosure(const LoopCloser& closer, ScanCheckpoint& checkpoint) {
    const Keyframes& keyframes = closer.keyframes();
    for (int id = 0; id < keyframes.size(); ++id) {
        checkpoint.keyframes.push_back(keyframes[id]);
        checkpoint.poses.emplace_back(
            id, KeyframePoses{keyframes[id].T_map_camera, keyframes[id].T_world_camera});
    }
    checkpoint.loops = LoopProgress{closer.graph().edges(), closer.store().next_ordinal(),
                                    closer.graph().loops(), closer.graph().corrected()};
}

int OverlapsAcross(const Keyframes& keyframes, int first_of_b) {
    int count = 0;
    for (int id = first_of_b; id < keyframes.size(); ++id)
        count += static_cast<int>(std::ranges::count_if(
            keyframes[id].overlaps,
            [&](const Overlap& overlap) { return overlap.with < first_of_b; }));
    return count;
}

// Writes to a file beside it first, so that an interrupted merge leaves no scan that looks whole.
class PartialFile {
  public:
    explicit PartialFile(std::string path) : path_(std::move(path)), partial_(path_ + ".part") {
        Remove();
    }
    ~PartialFile() { Remove(); }
    const std::string& partial() const { return partial_; }
    Status Complete() {
        std::error_code error;
        std::filesystem::rename(partial_, path_, error);
        if (!error) SyncFolderOf(path_);
        return error
                   ? Status::Error(fmt::format("{}: cannot be written: {}", path_, error.message()))
                   : Status::Ok();
    }

  private:
    void Remove() {
        std::error_code ignored;
        for (const char* suffix : {"", "-wal", "-shm"})
            std::filesystem::remove(partial_ + suffix, ignored);
    }
    std::string path_, partial_;
};

// The scans that are merged, and how.
struct Merge {
    Part &a, &b;
    const JointPose& pose;
    const Offsets& offsets;    // of b
    const LoopCloser& closer;  // of both
    const BlockMap& map;
};

ScanCheckpoint JointCheckpoint(const Merge& merge) {
    const ScanContent &a = merge.a.content, &b = merge.b.content;
    ScanCheckpoint checkpoint;
    std::vector<BlockId> blocks(static_cast<std::size_t>(merge.map.size()) - 1);
    std::iota(blocks.begin(), blocks.end(), BlockId{1});
    checkpoint.blocks.Copy(merge.map, blocks);
    AddPath(a, {}, Eigen::Isometry3d::Identity(), checkpoint);
    AddPath(b, merge.offsets, merge.pose.T_a_b, checkpoint);
    AddClosure(merge.closer, checkpoint);
    checkpoint.progress = Sum(a.progress, b.progress);
    checkpoint.source = b.source_name;
    checkpoint.finished = true;
    return checkpoint;
}

// Returns the number of frames.
Result<std::int64_t> WriteJoint(const Merge& merge, const std::string& out) {
    PartialFile partial(out);
    ScanMeta meta = merge.a.content.meta;
    meta.program = TESSERA_VERSION;
    meta.source_name += " + " + merge.b.content.meta.source_name;
    Result<std::unique_ptr<ScanFile>> file = ScanFile::Create(partial.partial(), meta.Encode());
    if (!file.ok()) return file.status();
    file.value()->Begin();
    for (const auto& [part, by] : {std::pair{&merge.a, Offsets{}}, {&merge.b, merge.offsets}})
        if (Status status = CopyFrames(*part, by, *file.value()); !status.ok()) return status;
    if (Status status = file.value()->Commit(false); !status.ok()) return status;
    const ScanCheckpoint checkpoint = JointCheckpoint(merge);
    ScanWriter writer(std::move(file.value()), meta.depth_units_per_m);
    if (Status status = writer.Write(checkpoint); !status.ok()) return status;
    writer.Close();
    if (Status status = partial.Complete(); !status.ok()) return status;
    return checkpoint.progress.frames;
}

}  // namespace

Result<MergeReport> MergeScans(const std::string& first, const std::string& second,
                               const std::string& out) {
    std::error_code ignored;
    if (std::filesystem::exists(out, ignored))
        return Status::Error(out + ": already exists; give another name");
    Result<Part> opened_a = Open(first);
    if (!opened_a.ok()) return opened_a.status();
    Result<Part> opened_b = Open(second);
    if (!opened_b.ok()) return opened_b.status();
    Part &a = opened_a.value(), &b = opened_b.value();
    const ScanMeta& meta = a.content.meta;
    if (Status status = CheckTogether(first, meta, second, b.content.meta); !status.ok())
        return status;

    // 1. Where the second lies in the first.
    const RunConfig config = ConfigOf(meta);
    const FieldSettings settings = FieldSettingsOf(config.pipeline, meta.camera);
    const auto closer_of = [&](LoopCloser::Memory memory) {
        auto closer = std::make_unique<LoopCloser>(config.loops, settings, meta.depth_units_per_m);
        closer->Resume(std::move(memory));
        return closer;
    };
    LoopCloser::Memory joint = TakeLoopMemory(a.content), added = TakeLoopMemory(b.content);
    const std::vector<CommonPlace> places =
        FindCommonPlaces(*closer_of(joint), added.frames, settings, meta.depth_units_per_m);
    const std::optional<JointPose> pose = AgreeOnPose(places, added.graph.keyframes);
    if (!pose)
        return Status::Error(fmt::format(
            "{} and {}: no common place was found ({} of {} keyframes of the second were seen in "
            "the first, and no two different ones agree); scan from where the first has been",
            first, second, places.size(), added.graph.keyframes.size()));
    const Offsets offsets{static_cast<std::int64_t>(a.content.path.size()), joint.next_ordinal,
                          static_cast<int>(joint.graph.keyframes.size())};

    // 2. One pose graph, and one map from the frames of both.
    AppendSession(std::move(added), *pose, joint);
    const auto closer = closer_of(std::move(joint));
    Result<LoopCloser::Correction> made = closer->MakeAgain();
    if (!made.ok()) return made.status();
    const BlockMap& map = *made.value().map;

    // 3. The new scan.
    const Result<std::int64_t> frames = WriteJoint({a, b, *pose, offsets, *closer, map}, out);
    if (!frames.ok()) return frames.status();
    return MergeReport{static_cast<int>(pose->places.size()), closer->keyframes().size(),
                       OverlapsAcross(closer->keyframes(), offsets.keyframe),
                       static_cast<std::int64_t>(map.size()) - 1, frames.value()};
}

}  // namespace tessera
