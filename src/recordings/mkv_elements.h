// The elements that Matroska files are made of (RFC 8794 and RFC 9559): an identifier, a length and
// content, which may again be elements. Content is not trusted. All functions are thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace tessera {

using MkvBytes = std::span<const std::uint8_t>;

// RFC 9559, section 5.1. The names are the RFC's.
enum class MkvId : std::uint32_t {
    kEbml = 0x1a45dfa3,
    kSegment = 0x18538067,
    kSeekHead = 0x114d9b74,
    kInfo = 0x1549a966,
    kTimestampScale = 0x2ad7b1,
    kTracks = 0x1654ae6b,
    kTrackEntry = 0xae,
    kTrackNumber = 0xd7,
    kTrackUid = 0x73c5,
    kTrackType = 0x83,
    kName = 0x536e,
    kCodecId = 0x86,
    kCodecPrivate = 0x63a2,
    kDefaultDuration = 0x23e383,
    kContentEncodings = 0x6d80,
    kVideo = 0xe0,
    kPixelWidth = 0xb0,
    kPixelHeight = 0xba,
    kCluster = 0x1f43b675,
    kTimestamp = 0xe7,
    kSimpleBlock = 0xa3,
    kBlockGroup = 0xa0,
    kBlock = 0xa1,
    kCues = 0x1c53bb6b,
    kChapters = 0x1043a770,
    kTags = 0x1254c367,
    kTag = 0x7373,
    kSimpleTag = 0x67c8,
    kTagName = 0x45a3,
    kTagString = 0x4487,
    kAttachments = 0x1941a469,
    kAttachedFile = 0x61a7,
    kFileName = 0x466e,
    kFileData = 0x465c,
    kVoid = 0xec,
    kCrc32 = 0xbf,
};

struct MkvElement {
    MkvId id{};
    std::uint32_t head_bytes = 0;
    std::uint64_t bytes = 0;    // of its content
    bool unknown_size = false;  // written without knowing it; `bytes` is 0
};

// The longest head of an element.
inline constexpr std::size_t kMostMkvHeadBytes = 12;

// The head of the element that starts here. nullopt: there is none, or it is cut off.
std::optional<MkvElement> ReadMkvHead(MkvBytes bytes);

// A number of one to eight bytes, in which the first says how many. nullopt: there is none.
struct MkvNumber {
    std::uint64_t value = 0;
    std::uint32_t bytes = 0;
};
std::optional<MkvNumber> ReadMkvNumber(MkvBytes bytes);

// Calls `take` for each element in `content`, up to one that does not fit into it.
void ForEachMkvElement(MkvBytes content, const std::function<void(MkvId, MkvBytes)>& take);

// An element's content as a number; 0 if it has more than eight bytes.
std::uint64_t MkvUnsigned(MkvBytes content);
// An element's content as text, up to the first zero.
std::string MkvText(MkvBytes content);

}  // namespace tessera
