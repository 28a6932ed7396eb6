#include "recordings/mkv_tables.h"

#include <cmath>

namespace tessera {
namespace {

constexpr std::uint64_t kMkvVideoTrack = 1;
constexpr std::size_t kMostMkvTracks = 64, kMostMkvTags = 10000, kMostMkvAttachments = 1000;

// Microsoft's codecs are named by four letters in a BITMAPINFOHEADER.
std::string MkvFormatOf(const std::string& codec, MkvBytes codec_private) {
    constexpr std::size_t kFourLetters = 16;
    if (codec == "V_MJPEG") return "MJPG";
    if (codec != "V_MS/VFW/FOURCC" || codec_private.size() < kFourLetters + 4) return codec;
    const MkvBytes letters = codec_private.subspan(kFourLetters, 4);
    return {letters.begin(), letters.end()};
}

// Of whole nanoseconds: 33333333 are 30 frames per second.
double MkvFpsOf(std::uint64_t frame_ns) {
    constexpr double kDigits = 1e4;
    return frame_ns > 0 ? std::round(kDigits * 1e9 / static_cast<double>(frame_ns)) / kDigits : 0;
}

MkvTrack ReadMkvTrack(MkvBytes content) {
    MkvTrack track;
    std::string codec;
    MkvBytes codec_private;
    ForEachMkvElement(content, [&](MkvId id, MkvBytes value) {
        switch (id) {
            case MkvId::kTrackNumber: track.number = MkvUnsigned(value); break;
            case MkvId::kTrackUid: track.uid = MkvUnsigned(value); break;
            case MkvId::kTrackType: track.is_video = MkvUnsigned(value) == kMkvVideoTrack; break;
            case MkvId::kName: track.name = MkvText(value); break;
            case MkvId::kCodecId: codec = MkvText(value); break;
            case MkvId::kCodecPrivate: codec_private = value; break;
            case MkvId::kContentEncodings: track.is_packed = true; break;
            case MkvId::kDefaultDuration: track.fps = MkvFpsOf(MkvUnsigned(value)); break;
            case MkvId::kVideo:
                ForEachMkvElement(value, [&](MkvId inner, MkvBytes number) {
                    if (inner == MkvId::kPixelWidth) track.width = MkvUnsigned(number);
                    if (inner == MkvId::kPixelHeight) track.height = MkvUnsigned(number);
                });
                break;
            default: break;
        }
    });
    track.format = MkvFormatOf(codec, codec_private);
    return track;
}

}  // namespace

std::uint64_t MkvTickOf(MkvBytes info) {
    constexpr std::uint64_t kMostNs = 1'000'000'000;
    std::uint64_t tick_ns = kUsualMkvTick_ns;
    ForEachMkvElement(info, [&](MkvId id, MkvBytes value) {
        if (id == MkvId::kTimestampScale) tick_ns = MkvUnsigned(value);
    });
    return tick_ns > 0 && tick_ns <= kMostNs ? tick_ns : kUsualMkvTick_ns;
}

void AddMkvTracks(MkvBytes content, std::vector<MkvTrack>& tracks) {
    ForEachMkvElement(content, [&](MkvId id, MkvBytes value) {
        if (id == MkvId::kTrackEntry && tracks.size() < kMostMkvTracks)
            tracks.push_back(ReadMkvTrack(value));
    });
}

void AddMkvTags(MkvBytes content, std::map<std::string, std::string>& tags) {
    const auto take_tag = [&](MkvBytes tag) {
        std::string name, text;
        ForEachMkvElement(tag, [&](MkvId id, MkvBytes value) {
            if (id == MkvId::kTagName) name = MkvText(value);
            if (id == MkvId::kTagString) text = MkvText(value);
        });
        if (tags.size() < kMostMkvTags) tags.try_emplace(name, text);
    };
    ForEachMkvElement(content, [&](MkvId id, MkvBytes value) {
        if (id != MkvId::kTag) return;
        ForEachMkvElement(value, [&](MkvId inner, MkvBytes tag) {
            if (inner == MkvId::kSimpleTag) take_tag(tag);
        });
    });
}

void AddMkvAttachment(MkvBytes content, std::uint64_t offset,
                      std::vector<MkvAttachment>& attachments) {
    MkvAttachment attachment;
    ForEachMkvElement(content, [&](MkvId id, MkvBytes value) {
        if (id == MkvId::kFileName) attachment.name = MkvText(value);
        if (id != MkvId::kFileData) return;
        attachment.offset = offset + static_cast<std::uint64_t>(value.data() - content.data());
        attachment.bytes = value.size();
    });
    if (attachments.size() < kMostMkvAttachments) attachments.push_back(std::move(attachment));
}

}  // namespace tessera
