#include "scan/cube_scratch.h"

#include <fmt/format.h>

#include <cstring>

#include "scan/checksum.h"

namespace tessera {
namespace {

// Precedes each row.
struct RowHead {
    std::int64_t key = 0;
    std::uint64_t bytes = 0;
};

}  // namespace

Result<std::shared_ptr<CubeScratch>> CubeScratch::Create(const std::string& beside_path) {
    Result<std::shared_ptr<TemporaryFile>> file = TemporaryFile::CreateBeside(beside_path);
    if (!file.ok()) return file.status();
    return std::shared_ptr<CubeScratch>(new CubeScratch(std::move(file.value()), beside_path));
}

Status CubeScratch::Error(const std::string& what) const {
    return Status::Error(fmt::format("{}: the temporary file of the rebuilt map {}", path_, what));
}

// Takes the smallest gap that is large enough; otherwise appends at the end.
CubeScratch::Place CubeScratch::Room(std::uint64_t bytes) {
    constexpr std::uint64_t kStep = 16384;
    Place place;
    place.bytes = bytes;
    place.room = (bytes + kStep - 1) / kStep * kStep;
    const auto gap = free_.lower_bound(place.room);
    if (gap == free_.end()) {
        place.offset = end_;
        end_ += place.room;
        return place;
    }
    place.offset = gap->second;
    const std::uint64_t rest = gap->first - place.room;
    free_.erase(gap);
    if (rest > 0) free_.emplace(rest, place.offset + place.room);
    return place;
}

Status CubeScratch::Put(std::int64_t cube_key, const BlockCopies& blocks) {
    rows_.clear();
    for (const auto& [key, i] : blocks.ByKey()) {
        const std::vector<std::uint8_t>& row = codec_.Encode(blocks, i);
        const RowHead head{key, row.size()};
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(&head);
        rows_.insert(rows_.end(), bytes, bytes + sizeof(head));
        rows_.insert(rows_.end(), row.begin(), row.end());
    }
    if (const auto before = places_.find(cube_key); before != places_.end()) {
        free_.emplace(before->second.room, before->second.offset);
        places_.erase(before);
    }
    Place place = Room(rows_.size());
    place.blocks = static_cast<std::int32_t>(blocks.size());
    place.checksum = Crc64(rows_);
    if (Status status = file_->Write(rows_, place.offset); !status.ok())
        return Error(status.message());
    places_[cube_key] = place;
    return Status::Ok();
}

Status CubeScratch::ReadRows(const Place& place, std::vector<std::uint8_t>& rows,
                             const TakeRow& take) const {
    rows.resize(place.bytes);
    if (Status status = file_->Read(rows, place.offset); !status.ok())
        return Error(status.message());
    if (Crc64(rows) != place.checksum) return Error("was damaged; check the disk");
    for (std::size_t at = 0; at < rows.size();) {
        RowHead head;
        std::memcpy(&head, rows.data() + at, sizeof(head));
        at += sizeof(head);
        if (Status status = take(head.key, std::span(rows).subspan(at, head.bytes)); !status.ok())
            return status;
        at += head.bytes;
    }
    return Status::Ok();
}

Status CubeScratch::Read(std::int64_t cube_key, BlockCopies& blocks) const {
    blocks.Clear();
    std::vector<std::uint8_t> rows;
    BlockCodec codec;
    return ReadRows(
        places_.at(cube_key), rows, [&](std::int64_t key, std::span<const std::uint8_t> data) {
            return codec.Decode(key, data, blocks) ? Status::Ok()
                                                   : Error("was damaged; check the disk");
        });
}

std::map<std::int64_t, std::int32_t> CubeScratch::Cubes() const {
    std::map<std::int64_t, std::int32_t> cubes;
    for (const auto& [key, place] : places_) cubes[key] = place.blocks;
    return cubes;
}

std::int32_t CubeScratch::Count(std::int64_t cube_key) const {
    const auto place = places_.find(cube_key);
    return place == places_.end() ? 0 : place->second.blocks;
}

Status CubeScratch::ForEachRow(const TakeRow& take) const {
    std::vector<std::uint8_t> rows;
    for (const auto& [key, place] : places_)
        if (Status status = ReadRows(place, rows, take); !status.ok()) return status;
    return Status::Ok();
}

}  // namespace tessera
