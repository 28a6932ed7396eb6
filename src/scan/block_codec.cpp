#include "scan/block_codec.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

namespace tessera {
namespace {

constexpr std::size_t kIdBytes = sizeof(BlockId);
constexpr std::size_t kLayerBytes = kBlockVoxels * (sizeof(FieldWord) + sizeof(std::uint16_t) + sizeof(ColourWord));
constexpr std::size_t kLabelBytes = kBlockVoxels * sizeof(VoxelLabel);

// Byte b of every element, for each b in turn.
template <class T>
std::uint8_t* ToPlanes(const T* values, std::uint8_t* out) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
    for (std::size_t b = 0; b < sizeof(T); ++b)
        for (std::size_t i = 0; i < kBlockVoxels; ++i) *out++ = bytes[i * sizeof(T) + b];
    return out;
}

template <class T>
const std::uint8_t* FromPlanes(const std::uint8_t* in, T* values) {
    auto* bytes = reinterpret_cast<std::uint8_t*>(values);
    for (std::size_t b = 0; b < sizeof(T); ++b)
        for (std::size_t i = 0; i < kBlockVoxels; ++i) bytes[i * sizeof(T) + b] = *in++;
    return in;
}

std::size_t ContentBytes(std::span<const std::uint8_t> row) {
    if (row.size() <= kIdBytes) return 0;
    const std::uint64_t size = Compressor::ContentSize(row.subspan(kIdBytes));
    return size == kLayerBytes || size == kLayerBytes + kLabelBytes ? static_cast<std::size_t>(size) : 0;
}

}  // namespace

void BlockCopies::Copy(const BlockMap& map, std::span<const BlockId> blocks) {
    ids.assign(blocks.begin(), blocks.end());
    coords.resize(ids.size());
    const std::size_t voxels = ids.size() * kBlockVoxels;
    field.resize(voxels);
    weight.resize(voxels);
    colour.resize(voxels);
    labels.resize(map.has_labels() ? voxels : 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ids.size(), 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const BlockId id = ids[i];
            const std::size_t at = i * kBlockVoxels;
            coords[i] = map.coord(id);
            std::copy_n(map.field(id), kBlockVoxels, field.data() + at);
            std::copy_n(map.weight(id), kBlockVoxels, weight.data() + at);
            std::copy_n(map.colour(id), kBlockVoxels, colour.data() + at);
            if (map.has_labels()) std::copy_n(map.label(id), kBlockVoxels, labels.data() + at);
        }
    });
}

const std::vector<std::uint8_t>& BlockCodec::Encode(const BlockCopies& copies, std::size_t index) {
    const std::size_t at = index * kBlockVoxels;
    content_.resize(kLayerBytes + (copies.labels.empty() ? 0 : kLabelBytes));
    std::uint8_t* out = ToPlanes(copies.field.data() + at, content_.data());
    out = ToPlanes(copies.weight.data() + at, out);
    out = ToPlanes(copies.colour.data() + at, out);
    if (!copies.labels.empty()) ToPlanes(copies.labels.data() + at, out);
    row_.resize(kIdBytes);
    std::memcpy(row_.data(), &copies.ids[index], kIdBytes);
    compressor_.Compress(content_, row_);
    return row_;
}

std::optional<BlockId> BlockCodec::IdOf(std::span<const std::uint8_t> row) {
    if (ContentBytes(row) == 0) return std::nullopt;
    BlockId id;
    std::memcpy(&id, row.data(), kIdBytes);
    return id;
}

bool BlockCodec::Decode(std::span<const std::uint8_t> row, BlockMap& map, BlockId id) {
    content_.resize(ContentBytes(row));
    if (content_.empty() || !compressor_.Decompress(row.subspan(kIdBytes), content_)) return false;
    const std::uint8_t* in = FromPlanes(content_.data(), map.field(id));
    in = FromPlanes(in, map.weight(id));
    in = FromPlanes(in, map.colour(id));
    if (map.has_labels() && content_.size() == kLayerBytes + kLabelBytes) FromPlanes(in, map.label(id));
    return true;
}

}  // namespace tessera
