#include "cuda/device_map.h"

#include "cuda/map_kernels.h"

namespace tessera::TESSERA_DEVICE {
namespace {

constexpr std::int32_t kFirstBlocks = 1024;
// As in BlockMap: the range of a signed voxel index.
constexpr std::int32_t kMaxBlocks = 1 << 22;
constexpr int kFirstWanted = 1 << 14;

}  // namespace

DeviceMap::DeviceMap(double voxel_size_m, const TruncationBand& band, DeviceMemory& memory,
                     Stream& stream)
    : voxel_size_m_(voxel_size_m),
      band_(band),
      memory_(memory),
      stream_(stream),
      layers_(memory),
      neighbours_(memory),
      coords_(memory),
      revision_(memory),
      table_(memory),
      sorter_(memory),
      wanted_(memory),
      count_(memory),
      keep_(memory),
      visible_(memory),
      selected_(memory),
      part_(memory) {}

bool DeviceMap::Layers::Reserve(Stream& stream, std::size_t blocks, std::size_t keep) {
    return field.Reserve(stream, blocks * kBlockVoxels, keep * kBlockVoxels) &&
           colour.Reserve(stream, blocks * kBlockVoxels, keep * kBlockVoxels) &&
           weight.Reserve(stream, blocks * kBlockVoxels, keep * kBlockVoxels);
}

DeviceMapView DeviceMap::view() {
    return {layers_.field.data(),
            layers_.weight.data(),
            layers_.colour.data(),
            neighbours_.data(),
            coords_.data(),
            revision_.data(),
            table_.data(),
            static_cast<std::uint32_t>(table_slots_ - 1),
            static_cast<float>(voxel_size_m_),
            band_};
}

bool DeviceMap::Clear() {
    size_ = 0;
    full_ = false;
    table_slots_ = 0;
    if (!Reserve(kFirstBlocks) || !count_.Reserve(stream_, 2, 0) ||
        !part_.Reserve(stream_, kBlocksPerPart, 0))
        return false;
    const std::int32_t unknown[4] = {kBlockLimit, kBlockLimit, kBlockLimit, 0};
    stream_.Upload(coords_.data(), unknown, sizeof unknown);
    stream_.Fill(neighbours_.data(), 0, 8 * sizeof(std::int32_t));
    stream_.Fill(revision_.data(), 0, sizeof(std::uint32_t));
    ForEach(stream_, kBlockVoxels, ClearVoxels{view(), 0});
    size_ = 1;
    return true;
}

bool DeviceMap::Load(std::int32_t size, const std::int32_t* coords, const FieldWord* field,
                     const std::uint16_t* weight, const ColourWord* colour) {
    if (!Clear() || !Reserve(size)) return false;
    const auto blocks = static_cast<std::size_t>(size), voxels = blocks * kBlockVoxels;
    stream_.Upload(coords_.data(), coords, 4 * blocks * sizeof *coords);
    stream_.Upload(layers_.field.data(), field, voxels * sizeof *field);
    stream_.Upload(layers_.weight.data(), weight, voxels * sizeof *weight);
    stream_.Upload(layers_.colour.data(), colour, voxels * sizeof *colour);
    stream_.Fill(revision_.data(), 0, blocks * sizeof(std::uint32_t));
    ForEach(stream_, size - 1, InsertIntoTable{view(), 1});
    ForEach(stream_, 8 * (size - 1), LinkNeighbours{view(), 1});
    size_ = size;
    return true;
}

// Makes room for this many blocks and their table slots. Allocates more at once while that is
// possible, so that it seldom grows.
bool DeviceMap::Reserve(std::int32_t blocks) {
    if (blocks > kMaxBlocks) return false;
    if (static_cast<std::size_t>(blocks) > revision_.capacity()) {
        const auto more = [blocks](int share) {
            return std::min(blocks + blocks / share, kMaxBlocks);
        };
        if (full_) return false;
        full_ = !GrowTo(more(2)) && !GrowTo(more(8)) && !GrowTo(more(32));
        if (full_) return false;
    }
    return GrowTable(blocks);
}

// revision_, whose capacity is the number of blocks, grows last.
bool DeviceMap::GrowTo(std::int32_t blocks) {
    // While a layer grows, it exists twice.
    constexpr std::size_t kBlockBytes =
        kBlockVoxels * (sizeof(FieldWord) + sizeof(ColourWord) + sizeof(std::uint16_t)) +
        (8 + 4 + 1 + 1 + 1) * sizeof(std::int32_t) + sizeof(std::uint8_t);
    const auto count = static_cast<std::size_t>(blocks), have = static_cast<std::size_t>(size_);
    const std::size_t before = revision_.capacity(),
                      twice = before * kBlockVoxels * sizeof(FieldWord);
    if (!memory_.HasRoom((count - before) * kBlockBytes + twice)) return false;
    return layers_.Reserve(stream_, count, have) &&
           neighbours_.Reserve(stream_, count * 8, have * 8) &&
           coords_.Reserve(stream_, count * 4, have * 4) && keep_.Reserve(stream_, count, 0) &&
           visible_.Reserve(stream_, count, 0) && selected_.Reserve(stream_, count, 0) &&
           sorter_.ReserveSelection(stream_, blocks) && revision_.Reserve(stream_, count, have);
}

// Keeps the table at most half full.
bool DeviceMap::GrowTable(std::int32_t blocks) {
    std::size_t slots = std::max<std::size_t>(table_slots_, 1024);
    while (slots <= 2 * static_cast<std::size_t>(blocks)) slots *= 2;
    if (slots == table_slots_) return true;
    if (!table_.Reserve(stream_, slots, 0)) return false;
    table_slots_ = slots;
    stream_.Fill(table_.data(), 0, slots * sizeof(std::int32_t));
    ForEach(stream_, size_ - 1, InsertIntoTable{view(), 1});
    return true;
}

// Fills wanted_.keys with every wanted block once, in any order.
bool DeviceMap::MarkWanted(const BandWalk& walk, const WorldBox& box, int& wanted) {
    std::size_t capacity = std::max<std::size_t>(kFirstWanted, wanted_.keys.capacity());
    while (true) {
        std::size_t slots = 1;
        while (slots < 2 * capacity) slots *= 2;
        if (!wanted_.keys.Reserve(stream_, capacity, 0) ||
            !wanted_.sorted.Reserve(stream_, capacity, 0) ||
            !wanted_.set.Reserve(stream_, slots, 0))
            return false;
        stream_.Fill(wanted_.set.data(), 0, slots * sizeof(std::uint64_t));
        stream_.Fill(count_.data(), 0, 2 * sizeof(std::int32_t));
        const KeySet set{wanted_.set.data(),  static_cast<std::uint32_t>(slots - 1),
                         wanted_.keys.data(), count_.data(),
                         count_.data() + 1,   static_cast<std::int32_t>(capacity)};
        ForEach(stream_, walk.columns() * walk.rows(),
                MarkWantedBlocks{walk, box, voxel_size_m_ * kBlockSide, view(), set});
        std::int32_t counted[2];
        stream_.Download(counted, count_.data(), sizeof counted);
        stream_.Wait();
        wanted = counted[0];
        if (counted[1] == 0) return true;
        capacity *= 4;
    }
}

DeviceMap::Growth DeviceMap::Allocate(const BandWalk& walk, const WorldBox& box,
                                      int max_new_blocks) {
    Growth growth;
    int wanted = 0;
    if (!MarkWanted(walk, box, wanted)) {
        growth.full = true;
        return growth;
    }
    growth.wanted = wanted;
    int count = std::min(wanted, max_new_blocks);
    if (count == 0) return growth;
    if (!sorter_.SortKeys(stream_, wanted_.keys.data(), wanted_.sorted.data(), wanted)) count = 0;
    if (count > 0 && !Reserve(size_ + count)) {
        count = std::min(count, static_cast<std::int32_t>(revision_.capacity()) - size_);
        if (!GrowTable(size_ + count)) count = 0;
    }
    growth.full = count < std::min(wanted, max_new_blocks);
    std::vector<std::uint64_t> keys(static_cast<std::size_t>(count));
    stream_.Download(keys.data(), wanted_.sorted.data(), keys.size() * sizeof(std::uint64_t));
    AddBlocks(count);
    stream_.Wait();
    for (const std::uint64_t key : keys) growth.added.push_back(CoordOf(key));
    return growth;
}

void DeviceMap::AddBlocks(int count) {
    ForEach(stream_, count * kBlockVoxels, ClearVoxels{view(), size_});
    ForEach(stream_, count, PlaceBlocks{view(), size_, wanted_.sorted.data()});
    ForEach(stream_, count, InsertIntoTable{view(), size_});
    ForEach(stream_, 8 * count, LinkNeighbours{view(), size_});
    size_ += count;
}

int DeviceMap::FindVisible(const DepthTileView& tiles, const ViewCone& cone) {
    ForEach(stream_, size_, FlagVisible{view(), tiles, cone, keep_.data()});
    return Select(visible_);
}

int DeviceMap::SelectSince(std::uint32_t first) {
    ForEach(stream_, size_, FlagSince{view(), first, keep_.data()});
    return Select(selected_);
}

// Selects the ids that are flagged in keep_ and returns their number.
int DeviceMap::Select(DeviceBuffer<std::int32_t>& ids) {
    int count = 0;
    if (!sorter_.SelectIndices(stream_, keep_.data(), size_, ids.data(), count_.data())) return 0;
    stream_.Download(&count, count_.data(), sizeof count);
    stream_.Wait();
    return count;
}

void DeviceMap::DownloadPart(int begin, int count, BlockVoxels& out) {
    const auto blocks = static_cast<std::size_t>(count), voxels = blocks * kBlockVoxels;
    ForEach(stream_, static_cast<int>(voxels),
            GatherVoxels{view(), selected_.data() + begin, part_.field.data(), part_.weight.data(),
                         part_.colour.data()});
    out.ids.resize(blocks);
    out.field.resize(voxels);
    out.weight.resize(voxels);
    out.colour.resize(voxels);
    stream_.Download(out.ids.data(), selected_.data() + begin, blocks * sizeof(std::int32_t));
    stream_.Download(out.field.data(), part_.field.data(), voxels * sizeof(FieldWord));
    stream_.Download(out.weight.data(), part_.weight.data(), voxels * sizeof(std::uint16_t));
    stream_.Download(out.colour.data(), part_.colour.data(), voxels * sizeof(ColourWord));
    stream_.Wait();
}

}  // namespace tessera::TESSERA_DEVICE
