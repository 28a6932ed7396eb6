#include "recordings/mkv_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "recordings/mkv_elements.h"
#include "recordings/mkv_tables.h"

namespace tessera {
namespace {

constexpr std::uint64_t kMostMkvTableBytes = 16 << 20;
constexpr std::size_t kMostMkvBlocks = 4'000'000;  // a day of three tracks has two thirds of it
constexpr int kMostMkvDamages = 1000;
constexpr std::uint64_t kNoMkvEnd = std::numeric_limits<std::uint64_t>::max();

// What may stand in a cluster or block group and is not needed: Position, PrevSize, SilentTracks,
// EncryptedBlock, BlockDuration, references, CodecState, DiscardPadding, Slices, BlockAdditions.
constexpr std::array<std::uint32_t, 12> kPassedMkvIds{0xa7, 0xab, 0x5854, 0xaf,   0x9b, 0xfa,
                                                      0xfb, 0xfd, 0xa4,   0x75a2, 0x8e, 0x75a1};

// Walks over the elements in the file's order. Elements that contain blocks are entered, so that
// their own sizes, which may be unknown or damaged, do not matter.
class MkvWalk {
  public:
    explicit MkvWalk(const InputFile& file) : file_(file) {}

    MkvIndex Run() {
        std::uint64_t at = 0;
        while (at < file_.size() && blocks_ < kMostMkvBlocks) {
            const std::uint64_t next = Take(at);
            if (next != kNoMkvEnd) {
                at = next;
            } else if (damages_ == kMostMkvDamages || !FindCluster(at)) {
                index_.warnings.push_back(
                    fmt::format("the file is cut off or damaged at byte {}; what is before it is "
                                "read",
                                at));
                break;
            }
        }
        Warn();
        FinishTracks();
        return std::move(index_);
    }

  private:
    // Returns where the walk goes on; kNoMkvEnd if this is no element that can stand here.
    std::uint64_t Take(std::uint64_t at) {
        const std::optional<MkvElement> element = HeadAt(at);
        if (!element) return kNoMkvEnd;
        at += element->head_bytes;
        switch (element->id) {
            case MkvId::kCluster:
                cluster_end_ = element->unknown_size ? kNoMkvEnd : at + element->bytes;
                cluster_ticks_.reset();
                return at;
            case MkvId::kSegment:
            case MkvId::kBlockGroup:
            case MkvId::kAttachments: return at;
            default: break;
        }
        if (element->unknown_size || element->bytes > file_.size() - at) return kNoMkvEnd;
        const std::uint64_t next = at + element->bytes;
        if (at <= cluster_end_ && next > cluster_end_) return kNoMkvEnd;
        return TakeContent(element->id, at, element->bytes) ? next : kNoMkvEnd;
    }

    bool TakeContent(MkvId id, std::uint64_t at, std::uint64_t bytes) {
        switch (id) {
            case MkvId::kTimestamp: return TakeClusterStamp(at, bytes);
            case MkvId::kSimpleBlock:
            case MkvId::kBlock: return TakeBlock(at, bytes);
            case MkvId::kInfo:
            case MkvId::kTracks:
            case MkvId::kTags:
            case MkvId::kAttachedFile: return TakeTable(id, at, bytes);
            case MkvId::kEbml:
            case MkvId::kSeekHead:
            case MkvId::kCues:
            case MkvId::kChapters:
            case MkvId::kVoid:
            case MkvId::kCrc32: return true;
            default: return std::ranges::count(kPassedMkvIds, static_cast<std::uint32_t>(id)) > 0;
        }
    }

    bool TakeTable(MkvId id, std::uint64_t at, std::uint64_t bytes) {
        if (id == MkvId::kAttachedFile && bytes > kMostMkvAttachmentBytes) {
            index_.warnings.push_back("an attachment is too large and is not read");
            return true;
        }
        if (bytes > kMostMkvTableBytes) return false;
        content_.resize(static_cast<std::size_t>(bytes));
        if (!file_.ReadAt(at, content_).ok()) return false;
        switch (id) {
            case MkvId::kInfo:
                tick_ns_ = MkvTickOf(content_);
                cluster_ticks_.reset();  // they were of another unit
                break;
            case MkvId::kTracks: AddMkvTracks(content_, index_.tracks); break;
            case MkvId::kTags: AddMkvTags(content_, index_.tags); break;
            default: AddMkvAttachment(content_, at, index_.attachments);
        }
        return true;
    }

    bool TakeClusterStamp(std::uint64_t at, std::uint64_t bytes) {
        constexpr std::uint64_t kMostNs = std::uint64_t{1} << 51;  // 26 days
        std::uint8_t content[8];
        if (bytes > sizeof(content)) return false;
        const auto used = std::span(content).first(static_cast<std::size_t>(bytes));
        if (!file_.ReadAt(at, used).ok()) return false;
        const std::uint64_t ticks = MkvUnsigned(used);
        if (ticks > kMostNs / tick_ns_) return false;
        cluster_ticks_ = static_cast<std::int64_t>(ticks);
        return true;
    }

    // A block is the track's number, the stamp relative to the cluster's, flags and an image.
    bool TakeBlock(std::uint64_t at, std::uint64_t bytes) {
        constexpr std::uint32_t kRest = 3;
        constexpr std::uint8_t kLacing = 0x06;
        std::uint8_t content[8 + kRest];
        const auto used = std::span(content).first(
            static_cast<std::size_t>(std::min<std::uint64_t>(bytes, sizeof(content))));
        if (!cluster_ticks_ || bytes > kMostMkvBlockBytes || !file_.ReadAt(at, used).ok())
            return false;
        const std::optional<MkvNumber> number = ReadMkvNumber(used);
        if (!number || number->bytes + kRest > used.size()) return false;
        const auto track = std::ranges::find(index_.tracks, number->value, &MkvTrack::number);
        if (track == index_.tracks.end() || !track->is_video) return true;
        const std::uint8_t* rest = used.data() + number->bytes;
        if ((rest[2] & kLacing) != 0) {
            ++laced_;
            return true;
        }
        const auto ticks = static_cast<std::int16_t>(rest[0] << 8 | rest[1]);
        const std::uint64_t head = number->bytes + kRest;
        track->blocks.push_back({(*cluster_ticks_ + ticks) * static_cast<std::int64_t>(tick_ns_),
                                 at + head, static_cast<std::uint32_t>(bytes - head)});
        ++blocks_;
        return true;
    }

    std::optional<MkvElement> HeadAt(std::uint64_t at) {
        std::uint8_t head[kMostMkvHeadBytes];
        const auto used = std::span(head).first(
            static_cast<std::size_t>(std::min<std::uint64_t>(sizeof(head), file_.size() - at)));
        if (!file_.ReadAt(at, used).ok()) return std::nullopt;
        return ReadMkvHead(used);
    }

    // Moves `at` to the next cluster after it. The parts that are searched grow, so that neither
    // many damages nor a long one take long.
    bool FindCluster(std::uint64_t& at) {
        constexpr std::array<std::uint8_t, 4> kId{0x1f, 0x43, 0xb6, 0x75};
        constexpr std::size_t kLeast = 4 << 10, kMost = 1 << 20;
        std::uint64_t from = at + 1;
        cluster_end_ = kNoMkvEnd;
        for (std::size_t part = kLeast; from + kId.size() <= file_.size();
             part = std::min(2 * part, kMost)) {
            content_.resize(
                static_cast<std::size_t>(std::min<std::uint64_t>(part, file_.size() - from)));
            if (!file_.ReadAt(from, content_).ok()) return false;
            const auto found =
                std::search(content_.begin(), content_.end(), kId.begin(), kId.end());
            if (found != content_.end()) {
                from += static_cast<std::uint64_t>(found - content_.begin());
                if (++damages_ == 1) first_damage_ = at;
                skipped_ += from - at;
                at = from;
                return true;
            }
            from += content_.size() - (kId.size() - 1);
        }
        return false;
    }

    void Warn() {
        if (damages_ > 0)
            index_.warnings.push_back(fmt::format(
                "the file is damaged in {} place{}, first at byte {}; {} bytes are passed over",
                damages_, damages_ == 1 ? "" : "s", first_damage_, skipped_));
        if (laced_ > 0)
            index_.warnings.push_back(
                fmt::format("{} blocks of several images each are not read", laced_));
        if (blocks_ >= kMostMkvBlocks)
            index_.warnings.push_back(fmt::format("only the first {} images are read", blocks_));
    }

    void FinishTracks() {
        for (MkvTrack& track : index_.tracks) {
            std::ranges::stable_sort(track.blocks, {}, &MkvBlock::stamp_ns);
            const auto repeated = std::unique(
                track.blocks.begin(), track.blocks.end(),
                [](const MkvBlock& a, const MkvBlock& b) { return a.stamp_ns == b.stamp_ns; });
            if (repeated != track.blocks.end())
                index_.warnings.push_back(
                    fmt::format("{} images of the track {} repeat a time stamp and are dropped",
                                track.blocks.end() - repeated, track.name));
            track.blocks.erase(repeated, track.blocks.end());
        }
    }

    const InputFile& file_;
    MkvIndex index_;
    std::uint64_t tick_ns_ = kUsualMkvTick_ns;
    std::optional<std::int64_t> cluster_ticks_;  // the stamp of the cluster
    std::uint64_t cluster_end_ = kNoMkvEnd;      // kNoMkvEnd: unknown
    std::size_t blocks_ = 0, laced_ = 0;
    int damages_ = 0;
    std::uint64_t first_damage_ = 0, skipped_ = 0;
    std::vector<std::uint8_t> content_;
};

}  // namespace

Result<MkvIndex> ReadMkvIndex(const InputFile& file) {
    std::uint8_t head[4]{};
    if (file.size() < sizeof(head) || !file.ReadAt(0, head).ok() ||
        MkvUnsigned(head) != static_cast<std::uint32_t>(MkvId::kEbml))
        return Status::Error(file.path() + ": is no Matroska file");
    return MkvWalk(file).Run();
}

}  // namespace tessera
