// The parts of a Matroska file that say what it contains: the unit of time stamps, tracks, tags and
// attachments. Content is not trusted; what is damaged is left out.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "recordings/mkv_elements.h"
#include "recordings/mkv_index.h"

namespace tessera {

inline constexpr std::uint64_t kUsualMkvTick_ns = 1'000'000;

// The unit of time stamps, from the content of Info: 1 ns to 1 s.
std::uint64_t MkvTickOf(MkvBytes info);

// From the content of Tracks; at most 64 tracks.
void AddMkvTracks(MkvBytes content, std::vector<MkvTrack>& tracks);

// From the content of Tags. Of tags with the same name, the first stays. At most 10000 tags.
void AddMkvTags(MkvBytes content, std::map<std::string, std::string>& tags);

// From the content of AttachedFile, which is at `offset` in the file. At most 1000 attachments.
void AddMkvAttachment(MkvBytes content, std::uint64_t offset,
                      std::vector<MkvAttachment>& attachments);

}  // namespace tessera
