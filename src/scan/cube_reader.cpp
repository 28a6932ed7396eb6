#include "scan/cube_reader.h"

#include <fmt/format.h>

#include <limits>

#include "scan/scan_file.h"

namespace tessera {
namespace {

// The next number must be valid, too.
bool IsNumber(std::int32_t number) {
    return number >= 1 && number < std::numeric_limits<std::int32_t>::max();
}

}  // namespace

Result<std::unique_ptr<CubeReader>> CubeReader::Open(const std::string& path) {
    Result<std::unique_ptr<Database>> database = Database::Open(path, Database::Access::kRead);
    if (!database.ok()) return database.status();
    Result<DatabaseStatement> select = database.value()->Prepare(
        SelectRows(ScanTable::kBlocks, "WHERE key BETWEEN ? AND ? ORDER BY key"));
    if (!select.ok()) return select.status();
    return std::unique_ptr<CubeReader>(
        new CubeReader(std::move(database.value()), std::move(select.value())));
}

// Distinguishes a read failure from a damaged file.
Status CubeReader::ReadError() const {
    return database_->damaged() ? DamagedScan(path(), "blocks")
                                : database_->Error("cannot be read");
}

Status CubeReader::Read(std::int64_t cube_key, BlockCopies& blocks) {
    blocks.Clear();
    select_.Bind(1, cube_key);
    select_.Bind(2, cube_key + kCubeKeys - 1);
    Status status = Status::Ok();
    int step = select_.Step();
    ScanRow row;
    for (; step == kStepRow && status.ok(); step = select_.Step())
        if (!ReadRow(select_, ScanTable::kBlocks, row) || CubeKeyOf(row.key) != cube_key ||
            !codec_.Decode(row.key, row.data, blocks) || !IsNumber(blocks.numbers.back()))
            status = DamagedScan(path(), fmt::format("block {}", row.key));
    if (status.ok() && step != kStepDone) status = ReadError();
    select_.Reset();  // ends the read, so that the writer can checkpoint its journal
    return status;
}

Result<std::vector<std::pair<std::int64_t, std::int32_t>>> CubeReader::Cubes() {
    Result<DatabaseStatement> keys = database_->Prepare("SELECT key FROM blocks ORDER BY key");
    if (!keys.ok()) return keys.status();
    std::vector<std::pair<std::int64_t, std::int32_t>> cubes;
    int step = keys.value().Step();
    for (; step == kStepRow; step = keys.value().Step()) {
        const std::int64_t cube = CubeKeyOf(keys.value().Number(0));
        if (cube < 0) return DamagedScan(path(), "blocks");
        if (cubes.empty() || cubes.back().first != cube) cubes.emplace_back(cube, 0);
        ++cubes.back().second;
    }
    if (step != kStepDone) return ReadError();
    return cubes;
}

}  // namespace tessera
