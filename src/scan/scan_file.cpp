#include "scan/scan_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/state_stream.h"

namespace tessera {
namespace {

constexpr std::int64_t kSealKey = static_cast<std::int64_t>(ScanStateKey::kSeal);

std::string TableSql(ScanTable table) {
    return fmt::format("CREATE TABLE {} (key INTEGER PRIMARY KEY, epoch INTEGER NOT NULL, checkpoint INTEGER NOT NULL, "
                       "data BLOB NOT NULL, checksum INTEGER NOT NULL)", ToString(table));
}

bool Exists(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

void Sync(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    ::fsync(file);
    ::close(file);
}

// Why the file cannot be a scan, by its first bytes; empty if it can.
std::string WhyNoScan(const std::string& path) {
    std::error_code ignored;
    if (!Exists(path)) return "no such file";
    if (std::filesystem::is_directory(path, ignored)) return "is a folder, not a scan";
    std::ifstream file(path, std::ios::binary);
    char magic[16] = {};
    if (!file.read(magic, sizeof(magic))) return "is not a scan (too short)";
    return std::memcmp(magic, "SQLite format 3", 16) == 0 ? "" : "is not a scan";
}

}  // namespace

Status DamagedScan(const std::string& path, const std::string& why) {
    return Status::Error(fmt::format("{}: damaged ({}); what is sound is recovered by: tessera scan repair {} --out NEW.scan",
                                     path, why, path));
}

std::vector<std::uint8_t> ScanSeal::Encode() const {
    std::vector<std::uint8_t> bytes;
    StateWriter state(bytes);
    state.Put(checkpoint);
    state.Put(finished);
    for (const Table& table : tables) {
        state.Put(table.epoch);
        state.Put(table.rows);
        state.Put(table.checksums);
    }
    return bytes;
}

bool ScanSeal::Decode(std::span<const std::uint8_t> bytes, ScanSeal& seal) {
    StateReader state(bytes);
    state.Get(seal.checkpoint);
    state.Get(seal.finished);
    for (Table& table : seal.tables) {
        state.Get(table.epoch);
        state.Get(table.rows);
        state.Get(table.checksums);
    }
    return state.at_end();
}

Result<std::unique_ptr<ScanFile>> ScanFile::Create(const std::string& path, std::span<const std::uint8_t> meta) {
    if (Exists(path)) return Status::Error(path + ": exists already; go on with it by --resume, or choose another name");
    const std::string unfinished = path + ".new";
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    {
        Result<std::unique_ptr<Database>> database = Database::Open(unfinished, Database::Access::kCreate);
        if (!database.ok()) return database.status();
        std::unique_ptr<ScanFile> file(new ScanFile());
        file->database_ = std::move(database.value());
        // Pages that hold several blocks and need no overflow pages for one.
        std::string sql = fmt::format("PRAGMA synchronous=OFF; PRAGMA page_size={}; PRAGMA application_id={}; PRAGMA user_version={}; ",
                                      kScanPageBytes, kScanApplicationId, kScanVersion);
        for (const ScanTable table : kScanTables) sql += TableSql(table) + "; ";
        Status made = file->database_->Execute(sql);
        if (made.ok()) made = file->PrepareToWrite();
        if (made.ok()) made = file->Begin();
        if (made.ok()) {
            file->next_.checkpoint = 0;
            made = file->Put(ScanTable::kMeta, 0, meta);
            // Once more on another page, for repair.
            if (made.ok()) made = file->Put(ScanTable::kState, static_cast<std::int64_t>(ScanStateKey::kMetaCopy), meta);
        }
        if (made.ok()) made = file->Commit(false);
        if (!made.ok()) {
            file.reset();
            std::filesystem::remove(unfinished, ignored);
            return made;
        }
    }
    Sync(unfinished);
    if (std::rename(unfinished.c_str(), path.c_str()) != 0)
        return Status::Error(fmt::format("{}: cannot be made: {}", path, std::strerror(errno)));
    return OpenToWrite(path);
}

Result<std::unique_ptr<ScanFile>> ScanFile::OpenToRead(const std::string& path) {
    if (!ScanAvailable()) return Status::Error(path + ": " + kScanUnavailable);
    if (const std::string why = WhyNoScan(path); !why.empty()) return Status::Error(path + ": " + why);
    std::unique_ptr<ScanFile> file(new ScanFile());
    Result<std::unique_ptr<Database>> database = Database::Open(path, Database::Access::kRead);
    if (!database.ok()) return database.status();
    file->database_ = std::move(database.value());
    // One state of the file for all that is read, also while another process goes on writing it.
    if (Status begun = file->database_->Execute("BEGIN"); !begun.ok()) return begun;
    if (Status status = file->CheckHeader(); !status.ok()) return status;
    if (Status status = file->LoadSeal(); !status.ok()) return status;
    return file;
}

Result<std::unique_ptr<ScanFile>> ScanFile::OpenToWrite(const std::string& path) {
    if (!ScanAvailable()) return Status::Error(path + ": " + kScanUnavailable);
    if (const std::string why = WhyNoScan(path); !why.empty()) return Status::Error(path + ": " + why);
    std::unique_ptr<ScanFile> file(new ScanFile());
    if (Status locked = file->Lock(path); !locked.ok()) return locked;
    Result<std::unique_ptr<Database>> database = Database::Open(path, Database::Access::kWrite);
    if (!database.ok()) return database.status();
    file->database_ = std::move(database.value());
    if (Status status = file->CheckHeader(); !status.ok()) return status;
    if (Status status = file->database_->Execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL; "
                                                 "PRAGMA journal_size_limit=67108864;");
        !status.ok())
        return status;
    if (Status status = file->LoadSeal(); !status.ok()) return status;
    if (Status status = file->PrepareToWrite(); !status.ok()) return status;
    return file;
}

ScanFile::~ScanFile() {
    statements_ = {};
    database_.reset();
    if (lock_ >= 0) ::close(lock_);
}

Status ScanFile::Lock(const std::string& path) {
    lock_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (lock_ < 0) return Status::Error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
        return Status::Error(path + ": another run is writing into it; wait for its end, or choose another file");
    return Status::Ok();
}

// A file that is no scan of a version that this program reads is refused before anything is believed of it.
Status ScanFile::CheckHeader() {
    const Result<std::int64_t> application = database_->Number("PRAGMA application_id");
    if (!application.ok()) return Failed("header");
    if (application.value() != kScanApplicationId) return Status::Error(path() + ": is not a scan (another program's database)");
    const Result<std::int64_t> version = database_->Number("PRAGMA user_version");
    if (!version.ok()) return Failed("header");
    if (version.value() > kScanVersion)
        return Status::Error(fmt::format("{}: is of format version {}, this program reads up to {}; use a newer tessera (or, if "
                                         "the file is damaged: tessera scan repair {} --out NEW.scan)",
                                         path(), version.value(), kScanVersion, path()));
    if (version.value() < 1) return DamagedScan(path(), "no format version");
    std::string tables;
    for (const ScanTable table : kScanTables) tables += fmt::format(" OR sql = '{}'", TableSql(table));
    const Result<std::int64_t> known = database_->Number("SELECT count(*) FROM sqlite_schema WHERE 0" + tables);
    const Result<std::int64_t> all = database_->Number("SELECT count(*) FROM sqlite_schema");
    if (!known.ok() || !all.ok()) return Failed("tables");
    if (known.value() != static_cast<std::int64_t>(kScanTableCount) || all.value() != known.value())
        return DamagedScan(path(), "tables");
    return Status::Ok();
}

Status ScanFile::LoadSeal() {
    Result<std::vector<std::uint8_t>> bytes = ReadOne(ScanTable::kState, kSealKey);
    if (!bytes.ok()) return bytes.status();
    if (!ScanSeal::Decode(bytes.value(), seal_)) return DamagedScan(path(), "no seal");
    return Status::Ok();
}

Status ScanFile::Failed(const std::string& doing) const {
    if (database_->damaged()) return DamagedScan(path(), doing);
    return database_->Error(doing + " cannot be read");
}

Status ScanFile::Read(ScanTable table, const std::function<Status(const ScanRow&)>& take) {
    const char* name = ToString(table);
    Result<DatabaseStatement> select =
        database_->Prepare(fmt::format("SELECT key, epoch, checkpoint, data, checksum FROM {} ORDER BY key", name));
    if (!select.ok()) return Failed(name);
    DatabaseStatement& rows = select.value();
    ScanSeal::Table found;
    const ScanSeal::Table& sealed = seal_.tables[IndexOf(table)];
    std::int64_t last = 0;
    bool first = true;
    int step = rows.Step();
    for (; step == kStepRow; step = rows.Step()) {
        const ScanRow row{table, rows.Number(0), rows.Number(1), rows.Number(2), rows.Bytes(3)};
        const std::uint64_t checksum = ChecksumOf(row);
        if (checksum != static_cast<std::uint64_t>(rows.Number(4)) || (!first && row.key <= last))
            return DamagedScan(path(), fmt::format("{} {}", name, row.key));
        first = false;
        last = row.key;
        if (table == ScanTable::kState && row.key == kSealKey) continue;
        ++found.rows;
        found.checksums += checksum;
        if (row.epoch != sealed.epoch || row.checkpoint > seal_.checkpoint || found.rows > sealed.rows)
            return DamagedScan(path(), fmt::format("{} {} is of another time", name, row.key));
        if (Status status = take(row); !status.ok()) return status;
    }
    if (step != kStepDone) return Failed(name);
    if (found.rows != sealed.rows)
        return DamagedScan(path(), fmt::format("{} of {} {} missing", sealed.rows - found.rows, sealed.rows, name));
    if (found.checksums != sealed.checksums) return DamagedScan(path(), fmt::format("{}: some are old", name));
    return Status::Ok();
}

Result<std::vector<std::uint8_t>> ScanFile::ReadOne(ScanTable table, std::int64_t key) {
    const char* name = ToString(table);
    Result<DatabaseStatement> select =
        database_->Prepare(fmt::format("SELECT key, epoch, checkpoint, data, checksum FROM {} WHERE key = ?", name));
    if (!select.ok()) return Failed(name);
    DatabaseStatement& found = select.value();
    found.Bind(1, key);
    const int step = found.Step();
    if (step == kStepDone) return std::vector<std::uint8_t>();
    if (step != kStepRow) return Failed(name);
    const ScanRow row{table, found.Number(0), found.Number(1), found.Number(2), found.Bytes(3)};
    if (row.key != key || ChecksumOf(row) != static_cast<std::uint64_t>(found.Number(4)))
        return DamagedScan(path(), fmt::format("{} {}", name, key));
    return std::vector<std::uint8_t>(row.data.begin(), row.data.end());
}

Status ScanFile::PrepareToWrite() {
    for (const ScanTable table : kScanTables) {
        const char* name = ToString(table);
        Result<DatabaseStatement> find = database_->Prepare(fmt::format("SELECT checksum FROM {} WHERE key = ?", name));
        Result<DatabaseStatement> replace =
            database_->Prepare(fmt::format("REPLACE INTO {} VALUES (?, ?, ?, ?, ?)", name));
        if (!find.ok() || !replace.ok()) return Failed(name);
        statements_[IndexOf(table)] = {std::move(find.value()), std::move(replace.value())};
    }
    return Status::Ok();
}

Status ScanFile::Begin() {
    next_ = seal_;
    ++next_.checkpoint;
    return database_->Execute("BEGIN IMMEDIATE");
}

Status ScanFile::Put(ScanTable table, std::int64_t key, std::span<const std::uint8_t> data) {
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
    if (found != kStepRow && found != kStepDone) return Abandon("cannot be written");
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
    const int step = statements.replace.Step();
    if (step != kStepDone) return Abandon("cannot be written");
    statements.replace.Reset();
    return Status::Ok();
}

Status ScanFile::Clear(ScanTable table) {
    ScanSeal::Table& sealed = next_.tables[IndexOf(table)];
    sealed = {sealed.epoch + 1, 0, 0};
    if (Status status = database_->Execute(fmt::format("DELETE FROM {}", ToString(table))); !status.ok())
        return Abandon("cannot be written");
    return Status::Ok();
}

Status ScanFile::Commit(bool finished) {
    next_.finished = finished;
    const std::vector<std::uint8_t> seal = next_.Encode();
    if (Status status = Put(ScanTable::kState, kSealKey, seal); !status.ok()) return status;
    if (Status status = database_->Execute("COMMIT"); !status.ok()) return Abandon("cannot be written");
    seal_ = next_;
    return Status::Ok();
}

Status ScanFile::Abandon(const std::string& doing) {
    const Status error = database_->Error(doing);
    for (Statements& statements : statements_) {
        statements.find.Reset();
        statements.replace.Reset();
    }
    static_cast<void>(database_->Execute("ROLLBACK"));  // where the library has rolled back itself there is nothing to do
    return error;
}

void ScanFile::Close() { static_cast<void>(database_->Execute("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode=DELETE;")); }

}  // namespace tessera
