// Rows of a scan file: checked reading, and writing in checkpoints.
#include <fmt/format.h>

#include "core/state_stream.h"
#include "scan/scan_file.h"

namespace tessera {

namespace {

// In the order of their bytes, as in scan_records.cpp. The tables follow the seal.
auto SealFields(auto& seal) { return std::tie(seal.checkpoint, seal.finished); }

auto SealedFields(auto& table) { return std::tie(table.epoch, table.rows, table.checksums); }

}  // namespace

std::vector<std::uint8_t> ScanSeal::Encode() const {
    std::vector<std::uint8_t> bytes = Encoded(SealFields(*this));
    for (const Table& table : tables) StateWriter(bytes).Put(SealedFields(table));
    return bytes;
}

bool ScanSeal::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    state.Get(SealFields(*this));
    for (Table& table : tables) state.Get(SealedFields(table));
    return state.at_end();
}

std::string SelectRows(ScanTable table, const std::string& which) {
    return fmt::format("SELECT key, epoch, checkpoint, data, checksum FROM {} {}", ToString(table),
                       which);
}

std::optional<std::uint64_t> ReadRow(const DatabaseStatement& statement, ScanTable table,
                                     ScanRow& row) {
    row = {table, statement.Number(0), statement.Number(1), statement.Number(2),
           statement.Bytes(3)};
    const std::uint64_t checksum = ChecksumOf(row);
    return checksum == static_cast<std::uint64_t>(statement.Number(4)) ? std::optional(checksum)
                                                                       : std::nullopt;
}

Status ScanFile::Failed(const std::string& doing) const {
    if (database_->damaged()) return DamagedScan(path(), doing);
    return database_->Error(doing + " cannot be read");
}

Status ScanFile::Read(ScanTable table, const std::function<Status(const ScanRow&)>& take) {
    const char* name = ToString(table);
    Result<DatabaseStatement> select = database_->Prepare(SelectRows(table, "ORDER BY key"));
    if (!select.ok()) return Failed(name);
    DatabaseStatement& rows = select.value();
    ScanSeal::Table found;
    const ScanSeal::Table& sealed = seal_.tables[IndexOf(table)];
    ScanRow row;
    std::optional<std::int64_t> last;
    int step = rows.Step();
    for (; step == kStepRow; step = rows.Step()) {
        const std::optional<std::uint64_t> checksum = ReadRow(rows, table, row);
        if (!checksum || (last && row.key <= *last))
            return DamagedScan(path(), fmt::format("{} {}", name, row.key));
        last = row.key;
        if (table == ScanTable::kState && row.key == kSealKey) continue;
        ++found.rows;
        found.checksums += *checksum;
        if (row.epoch != sealed.epoch || row.checkpoint > seal_.checkpoint ||
            found.rows > sealed.rows)
            return DamagedScan(path(),
                               fmt::format("{} {} is from another checkpoint", name, row.key));
        if (Status status = take(row); !status.ok()) return status;
    }
    if (step != kStepDone) return Failed(name);
    if (found.rows != sealed.rows)
        return DamagedScan(path(), fmt::format("{} of {} {} missing", sealed.rows - found.rows,
                                               sealed.rows, name));
    if (found.checksums != sealed.checksums)
        return DamagedScan(path(), fmt::format("{}: some rows are out of date", name));
    return Status::Ok();
}

Result<std::vector<std::uint8_t>> ScanFile::ReadOne(ScanTable table, std::int64_t key) {
    const char* name = ToString(table);
    Result<DatabaseStatement> select = database_->Prepare(SelectRows(table, "WHERE key = ?"));
    if (!select.ok()) return Failed(name);
    DatabaseStatement& found = select.value();
    found.Bind(1, key);
    const int step = found.Step();
    if (step == kStepDone) return std::vector<std::uint8_t>();
    if (step != kStepRow) return Failed(name);
    ScanRow row;
    if (!ReadRow(found, table, row) || row.key != key)
        return DamagedScan(path(), fmt::format("{} {}", name, key));
    return std::vector<std::uint8_t>(row.data.begin(), row.data.end());
}

Status ScanFile::PrepareToWrite() {
    for (const ScanTable table : kScanTables) {
        const char* name = ToString(table);
        Result<DatabaseStatement> find =
            database_->Prepare(fmt::format("SELECT checksum FROM {} WHERE key = ?", name));
        Result<DatabaseStatement> replace =
            database_->Prepare(fmt::format("REPLACE INTO {} VALUES (?, ?, ?, ?, ?)", name));
        if (!find.ok() || !replace.ok()) return Failed(name);
        statements_[IndexOf(table)] = {std::move(find.value()), std::move(replace.value())};
    }
    return Status::Ok();
}

void ScanFile::Begin() {
    next_ = seal_;
    ++next_.checkpoint;
    error_ = database_->Execute("BEGIN IMMEDIATE");
}

void ScanFile::Put(ScanTable table, std::int64_t key, std::span<const std::uint8_t> data) {
    if (!error_.ok()) return;
    Statements& statements = statements_[IndexOf(table)];
    ScanSeal::Table& sealed = next_.tables[IndexOf(table)];
    const ScanRow row{table, key, sealed.epoch, next_.checkpoint, data};
    const bool counted = table != ScanTable::kState || key != kSealKey;
    statements.find.Bind(1, key);
    const int found = statements.find.Step();
    if (counted && found == kStepRow) {
        --sealed.rows;
        sealed.checksums -= static_cast<std::uint64_t>(statements.find.Number(0));
    }
    statements.find.Reset();
    if (found != kStepRow && found != kStepDone)
        return Abandon(database_->Error("cannot be written"));
    const std::uint64_t checksum = ChecksumOf(row);
    if (counted) {
        ++sealed.rows;
        sealed.checksums += checksum;
    }
    statements.replace.Bind(1, key);
    statements.replace.Bind(2, row.epoch);
    statements.replace.Bind(3, row.checkpoint);
    statements.replace.Bind(4, data);
    statements.replace.Bind(5, static_cast<std::int64_t>(checksum));
    if (statements.replace.Step() != kStepDone)
        return Abandon(database_->Error("cannot be written"));
    statements.replace.Reset();
}

void ScanFile::Clear(ScanTable table) {
    if (!error_.ok()) return;
    ScanSeal::Table& sealed = next_.tables[IndexOf(table)];
    sealed = {sealed.epoch + 1, 0, 0};
    if (!database_->Execute(fmt::format("DELETE FROM {}", ToString(table))).ok())
        Abandon(database_->Error("cannot be written"));
}

Status ScanFile::Commit(bool finished) {
    next_.finished = finished;
    Put(ScanStateKey::kSeal, next_.Encode());
    if (!error_.ok()) return error_;
    // Older programs must not read what this one writes.
    const std::string sql = version_ < kScanVersion
                                ? fmt::format("PRAGMA user_version={}; COMMIT", kScanVersion)
                                : "COMMIT";
    if (!database_->Execute(sql).ok()) {
        Abandon(database_->Error("cannot be written"));
        return error_;
    }
    version_ = kScanVersion;
    seal_ = next_;
    return Status::Ok();
}

void ScanFile::Abandon(const Status& error) {
    if (!error_.ok()) return;
    error_ = error;
    for (Statements& statements : statements_) {
        statements.find.Reset();
        statements.replace.Reset();
    }
    // Nothing to do if the library has already rolled back.
    static_cast<void>(database_->Execute("ROLLBACK"));
}

void ScanFile::Close() {
    static_cast<void>(
        database_->Execute("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode=DELETE;"));
}

}  // namespace tessera
