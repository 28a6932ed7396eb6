#include "scan/scan_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/input_file.h"
#include "core/printable.h"
#include "io/file.h"

namespace tessera {
namespace {

std::string TableSql(ScanTable table) {
    return fmt::format(
        "CREATE TABLE {} (key INTEGER PRIMARY KEY, epoch INTEGER NOT NULL, checkpoint INTEGER NOT "
        "NULL, "
        "data BLOB NOT NULL, checksum INTEGER NOT NULL)",
        ToString(table));
}

bool Exists(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

bool HasContent(const std::string& path) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    return !error && bytes > 0;
}

void RemoveWithJournals(const std::string& path) {
    std::error_code ignored;
    for (const char* ending : {"", "-wal", "-shm", "-journal"})
        std::filesystem::remove(path + ending, ignored);
}

void Sync(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    ::fsync(file);
    ::close(file);
}

// Returns an error if the file cannot be a scan, judging by its first bytes. After a power cut its
// journal may have better ones.
Status CheckScan(const std::string& path) {
    if (!ScanAvailable()) return Status::Error(path + ": " + kScanUnavailable);
    std::array<std::uint8_t, 16> magic{};
    const Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    if (HasContent(path + "-wal") || HasContent(path + "-journal")) return Status::Ok();
    if (file.value().size() < magic.size())
        return Status::Error(path + ": is not a scan (too short)");
    if (Status status = file.value().ReadAt(0, magic); !status.ok()) return status;
    return std::memcmp(magic.data(), "SQLite format 3", magic.size()) == 0
               ? Status::Ok()
               : Status::Error(path + ": is not a scan");
}

// The run that wrote the file ended while SQLite put its journal away. Only a writer can finish it.
Status FinishEnd(const std::string& path) {
    Result<std::unique_ptr<Database>> database = Database::Open(path, Database::Access::kWrite);
    if (!database.ok()) return database.status();
    const Result<std::int64_t> finished = database.value()->Number("PRAGMA application_id");
    return finished.ok() ? Status::Ok()
                         : database.value()->Error(
                               "its last run was cut off while it ended; open "
                               "it once where it can be written");
}

}  // namespace

Status DamagedScan(const std::string& path, const std::string& why) {
    return Status::Error(fmt::format(
        "{}: damaged ({}); recover the intact part with: tessera scan repair {} --out NEW.scan",
        path, why, ShellLine({path})));
}

Result<std::unique_ptr<ScanFile>> ScanFile::Create(const std::string& path,
                                                   std::span<const std::uint8_t> meta) {
    if (Exists(path))
        return Status::Error(path +
                             ": already exists; continue it with --resume, or choose another name");
    // SQLite would treat it as the new file's journal.
    if (const std::string journal = path + "-wal"; HasContent(journal))
        return Status::Error(journal +
                             ": is the journal of a scan that is no longer here; put it back next "
                             "to its file, or remove it");
    const std::string unfinished = path + ".new";
    RemoveWithJournals(unfinished);
    {
        Result<std::unique_ptr<Database>> database =
            Database::Open(unfinished, Database::Access::kCreate);
        if (!database.ok()) return database.status();
        std::unique_ptr<ScanFile> file(new ScanFile());
        file->database_ = std::move(database.value());
        // The page size fits several blocks, so that a block needs no overflow pages.
        std::string sql = fmt::format(
            "PRAGMA synchronous=OFF; PRAGMA page_size={}; PRAGMA application_id={}; PRAGMA "
            "user_version={}; ",
            kScanPageBytes, kScanApplicationId, kScanVersion);
        for (const ScanTable table : kScanTables) sql += TableSql(table) + "; ";
        Status made = file->database_->Execute(sql);
        if (made.ok()) made = file->PrepareToWrite();
        if (made.ok()) {
            file->Begin();
            file->next_.checkpoint = 0;
            file->Put(ScanTable::kMeta, 0, meta);
            // Store a second copy on another page, for repair.
            file->Put(ScanStateKey::kMetaCopy, meta);
            made = file->Commit(false);
        }
        // Set WAL mode before the file gets its name: if the process is killed while SQLite changes
        // the mode, the file cannot be opened for reading.
        if (made.ok()) made = file->database_->Execute("PRAGMA journal_mode=WAL");
        if (!made.ok()) {
            file.reset();
            RemoveWithJournals(unfinished);
            return made;
        }
    }
    Sync(unfinished);
    if (std::rename(unfinished.c_str(), path.c_str()) != 0)
        return Status::Error(fmt::format("{}: cannot be created: {}", path, std::strerror(errno)));
    SyncFolderOf(path);
    Result<std::unique_ptr<ScanFile>> made = OpenToWrite(path);
    if (made.ok()) made.value()->fresh_ = true;
    return made;
}

Result<std::unique_ptr<ScanFile>> ScanFile::OpenToRead(const std::string& path) {
    if (Status status = CheckScan(path); !status.ok()) return status;
    std::unique_ptr<ScanFile> file(new ScanFile());
    Result<std::unique_ptr<Database>> database = Database::Open(path, Database::Access::kRead);
    if (!database.ok()) return database.status();
    file->database_ = std::move(database.value());
    if (!file->database_->Number("PRAGMA application_id").ok() && file->database_->needs_writer())
        if (Status status = FinishEnd(path); !status.ok()) return status;
    // Reads one consistent state of the file, even while another process writes to it.
    if (Status begun = file->database_->Execute("BEGIN"); !begun.ok()) return begun;
    if (Status status = file->CheckHeader(); !status.ok()) return status;
    if (Status status = file->LoadSeal(); !status.ok()) return status;
    return file;
}

Result<std::unique_ptr<ScanFile>> ScanFile::OpenToWrite(const std::string& path) {
    if (Status status = CheckScan(path); !status.ok()) return status;
    std::unique_ptr<ScanFile> file(new ScanFile());
    if (Status locked = file->Lock(path); !locked.ok()) return locked;
    Result<std::unique_ptr<Database>> database = Database::Open(path, Database::Access::kWrite);
    if (!database.ok()) return database.status();
    file->database_ = std::move(database.value());
    if (Status status = file->CheckHeader(); !status.ok()) return status;
    if (Status status = file->database_->Execute(
            "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; "
            "PRAGMA journal_size_limit=67108864; PRAGMA cache_size=-16384;");
        !status.ok())
        return status;
    if (Status status = file->LoadSeal(); !status.ok()) return status;
    if (Status status = file->PrepareToWrite(); !status.ok()) return status;
    return file;
}

ScanFile::~ScanFile() {
    statements_ = {};
    const std::string empty = fresh_ && seal_.checkpoint == 0 ? path() : "";
    database_.reset();
    if (!empty.empty()) RemoveWithJournals(empty);
    if (lock_ >= 0) ::close(lock_);
}

Status ScanFile::Lock(const std::string& path) {
    lock_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (lock_ < 0)
        return Status::Error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
        return Status::Error(
            path + ": another run is writing to it; wait until it ends, or choose another file");
    return Status::Ok();
}

// Refuses a file that is not a scan of a supported version, before anything in it is trusted.
Status ScanFile::CheckHeader() {
    const Result<std::int64_t> application = database_->Number("PRAGMA application_id");
    if (!application.ok()) return Failed("header");
    if (application.value() != kScanApplicationId)
        return Status::Error(path() + ": is not a scan (another program's database)");
    const Result<std::int64_t> version = database_->Number("PRAGMA user_version");
    if (!version.ok()) return Failed("header");
    if (version.value() > kScanVersion)
        return Status::Error(fmt::format(
            "{}: has format version {}, this program reads up to {}; use a newer tessera (or, if "
            "the file is damaged: tessera scan repair {} --out NEW.scan)",
            path(), version.value(), kScanVersion, ShellLine({path()})));
    if (version.value() < 1) return DamagedScan(path(), "no format version");
    version_ = version.value();
    std::string tables;
    for (const ScanTable table : kScanTables)
        tables += fmt::format(" OR sql = '{}'", TableSql(table));
    const Result<std::int64_t> known =
        database_->Number("SELECT count(*) FROM sqlite_schema WHERE 0" + tables);
    const Result<std::int64_t> all = database_->Number("SELECT count(*) FROM sqlite_schema");
    if (!known.ok() || !all.ok()) return Failed("tables");
    if (known.value() != static_cast<std::int64_t>(kScanTableCount) || all.value() != known.value())
        return DamagedScan(path(), "tables");
    return Status::Ok();
}

Status ScanFile::LoadSeal() {
    Result<std::vector<std::uint8_t>> bytes = ReadOne(ScanStateKey::kSeal);
    if (!bytes.ok()) return bytes.status();
    if (!seal_.Decode(bytes.value())) return DamagedScan(path(), "no seal");
    return Status::Ok();
}

}  // namespace tessera
