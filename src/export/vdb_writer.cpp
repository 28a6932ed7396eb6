#include "export/vdb_writer.h"

#include <fmt/format.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <ostream>
#include <streambuf>
#include <utility>
#include <vector>

#include "io/file.h"
#include "scan/checksum.h"

namespace tessera {
namespace {

static_assert(openvdb::FloatTree::LeafNodeType::DIM == kBlockSide, "one block maps to one leaf");

constexpr std::size_t kIdOffset = 21;  // after the magic number, three version numbers and a flag
constexpr std::size_t kIdBytes = 36;

template <class T>
std::uint64_t Checksum(const T* values, std::size_t count, std::uint64_t before) {
    return Crc64({reinterpret_cast<const std::uint8_t*>(values), count * sizeof(T)}, before);
}

// OpenVDB gives every file a random id. Derive it from the map instead, so that the same map gives
// the same bytes.
std::string FileId(const BlockMap& map) {
    std::uint64_t shape = 0, paint = 0;
    for (const double value : {map.config().voxel_size_m, map.config().truncation_m})
        shape = Checksum(&value, 1, shape);
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) continue;
        const BlockCoord coord = map.coord(id);
        shape = Checksum(&coord, 1, shape);
        shape = Checksum(map.field(id), kBlockVoxels, shape);
        paint = Checksum(map.colour(id), kBlockVoxels, paint);
    }
    return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", shape >> 32, shape >> 16 & 0xffff,
                       shape & 0xffff, paint >> 48, paint & 0xffffffffffff);
}

// A stream buffer for a file that appears complete or not at all. Replaces the file's id by `id`.
class AtomicBuffer : public std::streambuf {
  public:
    AtomicBuffer(AtomicFile& file, const std::string& id) : file_(file), id_(id), bytes_(1 << 20) {
        setp(bytes_.data(), bytes_.data() + bytes_.size());
    }

  protected:
    int_type overflow(int_type c) override {
        sync();
        if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
        return traits_type::not_eof(c);
    }
    int sync() override {
        const auto count = static_cast<std::size_t>(pptr() - pbase());
        if (!std::exchange(begun_, true) && count >= kIdOffset + kIdBytes)
            id_.copy(pbase() + kIdOffset, kIdBytes);
        file_.Write({pbase(), count});
        setp(bytes_.data(), bytes_.data() + bytes_.size());
        return 0;
    }

  private:
    AtomicFile& file_;
    const std::string id_;
    std::vector<char> bytes_;
    bool begun_ = false;
};

// IEC 61966-2-1.
float LinearOfSrgb(float s) {
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

// Copies each block to one leaf of each grid.
class LeafWriter {
  public:
    LeafWriter(openvdb::FloatGrid& surface, openvdb::Vec3SGrid& colour, const BlockMap::Config& map)
        : surface_(surface.tree()),
          colour_(colour.tree()),
          range_m_(static_cast<float>(map.range_m())),
          truncation_m_(static_cast<float>(map.truncation_m)) {}

    void Add(const BlockMap& map, BlockId id) {
        const FieldWord* field = map.field(id);
        const auto in_band = [this](FieldWord word) { return InBand(word); };
        if (std::none_of(field, field + kBlockVoxels, in_band)) return;
        const BlockCoord c = map.coord(id);
        const openvdb::Coord origin(c.x * kBlockSide, c.y * kBlockSide, c.z * kBlockSide);
        auto& surface = *surface_.touchLeaf(origin);
        auto& colour = *colour_.touchLeaf(origin);
        for (int i = 0; i < kBlockVoxels; ++i) {
            if (!HasDistance(field[i])) continue;
            // x varies fastest in our blocks, z in OpenVDB's leaves.
            const openvdb::Index at = openvdb::Index((i & 7) << 6 | (i & 0x38) | i >> 6);
            const float distance_m =
                std::clamp(range_m_ * FieldDistance(field[i]), -truncation_m_, truncation_m_);
            if (!InBand(field[i])) {
                surface.setValueOff(at, distance_m);
                continue;
            }
            surface.setValueOn(at, distance_m);
            const ColourWord word = map.colour(id)[i];
            if (!HasIntensity(field[i]) || ColourWeight(word) == 0) continue;
            const LinearRgb rgb = ColourFromWords(field[i], word);
            colour.setValueOn(at, {LinearOfSrgb(rgb.r), LinearOfSrgb(rgb.g), LinearOfSrgb(rgb.b)});
        }
    }

  private:
    // Rounding may leave a distance at the band's end one step short of it.
    bool InBand(FieldWord word) const {
        const float step_m = range_m_ / kDistanceSteps;
        return HasDistance(word) &&
               range_m_ * std::abs(FieldDistance(word)) < truncation_m_ - step_m;
    }

    openvdb::FloatTree& surface_;
    openvdb::Vec3STree& colour_;
    const float range_m_, truncation_m_;
};

Status Write(const std::string& path, const BlockMap& map) {
    openvdb::initialize();
    const auto transform =
        openvdb::math::Transform::createLinearTransform(map.config().voxel_size_m);
    const auto truncation_m = static_cast<float>(map.config().truncation_m);
    const auto surface = openvdb::FloatGrid::create(truncation_m);
    surface->setName("surface");
    surface->setGridClass(openvdb::GRID_LEVEL_SET);
    surface->setTransform(transform);
    const auto colour = openvdb::Vec3SGrid::create();
    colour->setName("Cd");
    colour->setVectorType(openvdb::VEC_INVARIANT);
    colour->setTransform(transform);
    LeafWriter leaves(*surface, *colour, map.config());
    for (BlockId id = 1; id < map.size(); ++id)
        if (!map.IsFree(id)) leaves.Add(map, id);
    AtomicFile file(path);
    AtomicBuffer buffer(file, FileId(map));
    std::ostream stream(&buffer);
    openvdb::io::Stream(stream).write(openvdb::GridCPtrVec{surface, colour});
    stream.flush();
    return file.Commit();
}

}  // namespace

bool VdbAvailable() { return true; }

Status WriteVdb(const std::string& path, const BlockMap& map) {
    try {
        return Write(path, map);
    } catch (const std::bad_alloc&) {
        return Status::Error(path + ": the grid does not fit in memory; use larger voxels");
    } catch (const std::exception& error) {
        return Status::Error(path + ": OpenVDB cannot write it: " + error.what());
    }
}

}  // namespace tessera
