#include "io/klg_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "io/klg_frame.h"

namespace tessera {
namespace {

template <class Value>
std::span<std::uint8_t> BytesOf(Value& value) {
    return {reinterpret_cast<std::uint8_t*>(&value), sizeof(value)};
}

// The longest subsequence of increasing stamps, so that one damaged stamp costs one frame.
std::vector<KlgEntry> WithIncreasingStamps(const std::vector<KlgEntry>& entries) {
    constexpr std::size_t kNone = ~std::size_t{0};
    std::vector<std::size_t> ends;  // by length: where the subsequence with the lowest end ends
    std::vector<std::size_t> before(entries.size(), kNone);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const auto place = std::ranges::lower_bound(
            ends, entries[i].stamp_us, {}, [&](std::size_t end) { return entries[end].stamp_us; });
        if (place != ends.begin()) before[i] = *(place - 1);
        if (place == ends.end())
            ends.push_back(i);
        else
            *place = i;
    }
    std::vector<KlgEntry> kept;
    for (std::size_t i = ends.empty() ? kNone : ends.back(); i != kNone; i = before[i])
        kept.push_back(entries[i]);
    std::ranges::reverse(kept);
    return kept;
}

}  // namespace

Result<KlgIndex> ReadKlgIndex(const InputFile& file, const PinholeCamera& camera) {
    std::int32_t count = 0;
    if (file.size() < sizeof(count) || !file.ReadAt(0, BytesOf(count)).ok() || count < 0)
        return Status::Error(file.path() +
                             ": is not a .klg log: it does not start with a frame count");
    KlgIndex index;
    std::vector<KlgEntry> entries;
    std::uint64_t at = sizeof(count);
    // The logger writes the count when it closes the log; until then it is 0.
    const bool unclosed = count == 0;
    while ((unclosed || std::ssize(entries) < count) && at + sizeof(KlgHeader) <= file.size()) {
        KlgHeader header;
        if (Status status = file.ReadAt(at, BytesOf(header)); !status.ok()) return status;
        if (!header.Fits(camera)) {
            const std::string what =
                fmt::format("frame {} has {} bytes of depth and {} of colour", entries.size(),
                            header.depth_bytes, header.colour_bytes);
            if (entries.empty())
                return Status::Error(fmt::format(
                    "{}: {}; this is not a .klg log, it is damaged, or its images are larger than "
                    "camera.yaml next to it says",
                    file.path(), what));
            index.warnings.push_back("the log is damaged: " + what);
            break;
        }
        KlgEntry entry;
        entry.stamp_us = header.stamp_us;
        entry.offset = at + sizeof(KlgHeader);
        entry.depth_bytes = static_cast<std::uint32_t>(header.depth_bytes);
        entry.colour_bytes = static_cast<std::uint32_t>(header.colour_bytes);
        at = entry.offset + entry.depth_bytes + entry.colour_bytes;
        if (at > file.size()) break;
        entries.push_back(entry);
    }
    const std::size_t whole = entries.size();
    if (unclosed)
        index.warnings.push_back(
            fmt::format("the log was not closed; {} frames were found", whole));
    else if (std::ssize(entries) < count)
        index.warnings.push_back(
            fmt::format("the log is truncated: {} of its {} frames are present", whole, count));
    index.entries = WithIncreasingStamps(entries);
    if (const auto dropped = whole - index.entries.size(); dropped > 0)
        index.warnings.push_back(fmt::format(
            "{} of {} frames are dropped: their time stamps do not increase", dropped, whole));
    if (index.entries.empty()) return Status::Error(file.path() + ": contains no complete frame");
    return index;
}

}  // namespace tessera
