// A scan file as tables of rows: one SQLite database. It is written in transactions that each end
// in a consistent state (a checkpoint). Every row is checked when it is read.
//
// A checkpoint's seal (in ScanTable::kState) holds each table's row count and the sum of its row
// checksums. So a row that is missing, outdated, moved or damaged is detected even if SQLite does
// not notice.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/status.h"
#include "scan/database.h"
#include "scan/scan_row.h"

namespace tessera {

struct ScanSeal {
    struct Table {
        std::int64_t epoch = 0, rows = 0;
        std::uint64_t checksums = 0;  // sum of the row checksums, modulo 2^64
    };
    std::int64_t checkpoint = 0;
    bool finished = false;  // the run that wrote it ended normally
    std::array<Table, kScanTableCount> tables;

    std::vector<std::uint8_t> Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// The error for a file with damaged content. It suggests `tessera scan repair`.
Status DamagedScan(const std::string& path, const std::string& why);

// The statement that selects rows of a table; `which` says which ones, and in which order.
std::string SelectRows(ScanTable table, const std::string& which);
// Reads the row at which such a statement stands. Returns its checksum; nullopt if that is wrong.
std::optional<std::uint64_t> ReadRow(const DatabaseStatement& statement, ScanTable table,
                                     ScanRow& row);

// Owner thread only. Errors name the file, what is wrong and what to do.
class ScanFile {
  public:
    // Creates a new file with a single checkpoint, number 0, that holds only `meta`. Fails if the
    // file or its journal already exists. The file appears at `path` complete or not at all.
    static Result<std::unique_ptr<ScanFile>> Create(const std::string& path,
                                                    std::span<const std::uint8_t> meta);
    // Refuses files that are not scans, files of a newer version, and files with a damaged header
    // or schema. Two runs cannot write to the same file.
    static Result<std::unique_ptr<ScanFile>> OpenToRead(const std::string& path);
    static Result<std::unique_ptr<ScanFile>> OpenToWrite(const std::string& path);
    // Discards uncommitted changes. Deletes a file made by Create that has no checkpoint but its
    // first.
    ~ScanFile();
    ScanFile(const ScanFile&) = delete;
    ScanFile& operator=(const ScanFile&) = delete;

    const std::string& path() const { return database_->path(); }
    const ScanSeal& seal() const { return seal_; }
    // Format version of the file. Writing to an older one makes it the newest.
    std::int64_t version() const { return version_; }

    // Reads every row of a table by increasing key. Checks each row against its checksum and, at
    // the end, the row count and checksum sum against the seal. Stops early if `take` returns an
    // error.
    Status Read(ScanTable table, const std::function<Status(const ScanRow&)>& take);
    // Returns the data of one row; empty if there is none.
    Result<std::vector<std::uint8_t>> ReadOne(ScanTable table, std::int64_t key);
    Result<std::vector<std::uint8_t>> ReadOne(ScanStateKey key) {
        return ReadOne(ScanTable::kState, static_cast<std::int64_t>(key));
    }

    // To write one checkpoint: Begin, any number of Put and Clear, Commit. The first error gives
    // the checkpoint up: the file is then as it was before Begin, the calls that follow do nothing,
    // and Commit returns the error.
    void Begin();
    void Put(ScanTable table, std::int64_t key, std::span<const std::uint8_t> data);
    void Put(ScanStateKey key, std::span<const std::uint8_t> data) {
        Put(ScanTable::kState, static_cast<std::int64_t>(key), data);
    }
    // Deletes all rows of the table. New rows belong to a new epoch.
    void Clear(ScanTable table);
    Status Commit(bool finished);
    // Gives the checkpoint up because of an error of the caller.
    void Abandon(const Status& error);
    const Status& error() const { return error_; }  // the first since Begin
    // Merges the journal into the file and removes it. Call it once, at the end of writing.
    void Close();

  private:
    struct Statements {
        DatabaseStatement find, replace;
    };

    ScanFile() = default;
    Status Lock(const std::string& path);
    Status CheckHeader();
    Status LoadSeal();
    Status PrepareToWrite();
    Status Failed(const std::string& doing) const;

    bool fresh_ = false;  // made by Create
    std::int64_t version_ = kScanVersion;
    // Holds the lock that keeps other writers out. Must outlive the database: closing this file
    // descriptor drops SQLite's locks.
    int lock_ = -1;
    std::unique_ptr<Database> database_;
    ScanSeal seal_, next_;  // as committed, and as it will be after Commit
    Status error_;
    std::array<Statements, kScanTableCount> statements_;
};

}  // namespace tessera
