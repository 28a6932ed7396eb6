#include "scan/scan_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>

#include "scan/block_codec.h"
#include "scan/found_rows.h"
#include "scan/scan_file.h"
#include "scan/scan_records.h"

namespace tessera {
namespace {

class Repair {
  public:
    Repair(std::unique_ptr<PageWalk> walk, const std::string& path, const std::string& out)
        : found_(std::move(walk)), path_(path), out_(out) {}

    Result<RepairReport> Run() {
        report_.lost = found_.Index();
        if (!FindMeta())
            return Status::Error(path_ + ": nothing can be recovered: the scan's metadata is lost");
        if (found_.rows(ScanTable::kBlocks).empty() && found_.rows(ScanTable::kPath).empty())
            return Status::Error(path_ +
                                 ": nothing can be recovered: no block and no pose is intact");
        JudgeLoops();
        ScanRow labels;
        labelled_ = found_.Load(ScanStateKey::kLabels, labels) && !labels.data.empty();
        Result<std::unique_ptr<ScanFile>> file = ScanFile::Create(out_, meta_.Encode());
        if (!file.ok()) return file.status();
        file_ = std::move(file.value());
        file_->Begin();
        CopyBlocks();
        CopyPath();
        if (meta_.loops) CopyKeyframes();
        CopyFrames();
        CopyState();
        if (Status status = file_->Commit(false); !status.ok()) return status;
        file_->Close();
        return std::move(report_);
    }

  private:
    bool FindMeta() {
        ScanRow row;
        return (found_.Load(ScanTable::kMeta, 0, row) && meta_.Decode(row.data)) ||
               (found_.Load(ScanStateKey::kMetaCopy, row) && meta_.Decode(row.data));
    }

    // Loop closure can continue only with all keyframes. Otherwise the path is written without
    // them.
    void JudgeLoops() {
        ScanRow row;
        const std::size_t count = found_.rows(ScanTable::kPoses).size();
        bool whole = meta_.loops && found_.Load(ScanStateKey::kLoops, row) &&
                     loops_.Decode(row.data) && found_.rows(ScanTable::kKeyframes).size() == count;
        Keyframe keyframe;
        for (const auto& [key, place] : found_.rows(ScanTable::kPoses)) {
            KeyframePoses poses;
            if (found_.Load(ScanTable::kPoses, key, row) && poses.Decode(row.data))
                poses_[key] = poses;
            whole = whole && found_.Load(ScanTable::kKeyframes, key, row) &&
                    DecodeKeyframe(row.data, meta_.camera, keyframe) &&
                    std::ranges::all_of(keyframe.overlaps,
                                        [id = key](const Overlap& o) { return o.with < id; });
        }
        for (const PoseEdge& edge : loops_.edges)
            whole = whole && edge.from >= 0 && edge.to >= 0 && edge.from != edge.to &&
                    std::max(edge.from, edge.to) < static_cast<int>(count);
        whole = whole && poses_.size() == count &&
                (count == 0 || poses_.rbegin()->first == static_cast<std::int64_t>(count) - 1);
        if (meta_.loops && !whole)
            report_.lost.push_back("keyframes or loops: the scan continues without loop closure");
        meta_.loops = whole;
    }

    // Renumbers the blocks without gaps, in their original order. Leaves out their labels if the
    // objects that these name are lost.
    void CopyBlocks() {
        std::vector<std::pair<BlockId, std::int64_t>> order;
        ScanRow row;
        for (const auto& [key, place] : found_.rows(ScanTable::kBlocks))
            if (found_.Load(ScanTable::kBlocks, key, row) && BlockCodec::NumberOf(row.data) &&
                key >= 0)
                order.emplace_back(*BlockCodec::NumberOf(row.data), key);
        std::ranges::sort(order);
        BlockId next = 1;
        BlockCodec codec;
        BlockCopies block;
        bool unlabelled = false;
        for (const auto& [id, key] : order) {
            found_.Load(ScanTable::kBlocks, key, row);
            Bytes data(row.data.begin(), row.data.end());
            block.Clear();
            if (!labelled_ && codec.Decode(key, data, block) && !block.labels.empty()) {
                unlabelled = true;
                block.labels.clear();
                data = codec.Encode(block, 0);
            }
            std::memcpy(data.data(), &next, sizeof(next));
            ++next;
            file_->Put(ScanTable::kBlocks, key, data);
            if (!file_->error().ok()) return;
        }
        if (unlabelled) report_.lost.push_back("the objects' labels");
        report_.blocks = next - 1;
    }

    void CopyPath() {
        ScanRow row;
        std::int64_t unplaced = 0;
        for (const auto& [key, place] : found_.rows(ScanTable::kPath)) {
            PathRecord record;
            if (!found_.Load(ScanTable::kPath, key, row) || !record.Decode(row.data)) continue;
            if (record.keyframe >= 0 && !meta_.loops) {
                const auto poses = poses_.find(record.keyframe);
                if (poses == poses_.end()) {
                    ++unplaced;
                    continue;
                }
                record.T_reference_camera =
                    Normalised(poses->second.T_world_camera * record.T_reference_camera);
                record.keyframe = -1;
            }
            if (record.keyframe >= static_cast<int>(poses_.size())) continue;
            new_key_[key] = report_.path;
            began_again_ = began_again_ || (last_ && record.index <= last_->index);
            last_ = record;
            file_->Put(ScanTable::kPath, report_.path++, record.Encode());
        }
        if (unplaced > 0)
            report_.lost.push_back(fmt::format("{} poses whose keyframe is lost", unplaced));
    }

    void CopyKeyframes() {
        ScanRow row;
        for (const auto& [key, poses] : poses_) {
            if (!found_.Load(ScanTable::kKeyframes, key, row)) continue;
            file_->Put(ScanTable::kKeyframes, key, row.data);
            file_->Put(ScanTable::kPoses, key, poses.Encode());
            ++report_.keyframes;
        }
    }

    void CopyFrames() {
        ScanRow row;
        for (const auto& [key, place] : found_.rows(ScanTable::kFrames)) {
            FrameRecord record;
            if (!new_key_.contains(key) || !found_.Load(ScanTable::kFrames, key, row) ||
                !record.Decode(row.data))
                continue;
            if (!meta_.loops) record.in_store = false;
            if (record.in_store && record.stored.keyframe >= static_cast<int>(poses_.size()))
                continue;
            const Result<Bytes> bytes = record.Encode();
            if (!bytes.ok()) return file_->Abandon(bytes.status());
            file_->Put(ScanTable::kFrames, new_key_[key], bytes.value());
            if (!file_->error().ok()) return;
            ++report_.frames;
        }
    }

    void CopyState() {
        ScanRow row;
        ScanProgress progress;
        if (!found_.Load(ScanStateKey::kProgress, row) || !progress.Decode(row.data)) {
            report_.lost.push_back("the progress record");
            progress = {};
            progress.fused_frames =
                static_cast<std::uint32_t>(std::max<std::int64_t>(1, report_.path));
            if (last_) {
                progress.last_index = last_->index;
                progress.last_stamp_s = last_->stamp_s;
            }
        }
        progress.frames = report_.path;
        progress.labels = labelled_;
        // Then the last index is of another source than the first session's.
        if (began_again_ && !found_.Load(ScanStateKey::kSource, row)) {
            report_.lost.push_back("the name of the last session's source");
            progress.last_index = -1;
        }
        file_->Put(ScanStateKey::kProgress, progress.Encode());
        for (const ScanStateKey key :
             {ScanStateKey::kTracking, ScanStateKey::kLabels, ScanStateKey::kSource})
            if (found_.Load(key, row)) {
                file_->Put(key, row.data);
            } else if (key == ScanStateKey::kTracking) {
                report_.lost.push_back("the tracking state at the end");
            }
        if (meta_.loops) file_->Put(ScanStateKey::kLoops, loops_.Encode());
    }

    FoundRows found_;
    std::string path_, out_;
    std::unique_ptr<ScanFile> file_;
    RepairReport report_;
    ScanMeta meta_;
    LoopProgress loops_;
    std::map<std::int64_t, KeyframePoses> poses_;
    std::map<std::int64_t, std::int64_t> new_key_;  // for the path
    std::optional<PathRecord> last_;
    bool labelled_ = false;     // the state of the labels is intact
    bool began_again_ = false;  // the path has another session's frames
};

}  // namespace

Result<RepairReport> RepairScan(const std::string& path, const std::string& out) {
    if (!ScanAvailable()) return Status::Error(path + ": " + kScanUnavailable);
    Result<std::unique_ptr<PageWalk>> walk = PageWalk::Open(path);
    if (!walk.ok()) return walk.status();
    return Repair(std::move(walk.value()), path, out).Run();
}

}  // namespace tessera
