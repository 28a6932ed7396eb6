// A scan file as its tables of rows: one SQLite database, written in transactions that each end in
// a consistent state (a checkpoint), read with every row checked.
//
// A checkpoint's seal (in ScanTable::kState) holds each table's number of rows and the sum of their
// checksums: a row that is missing, old, moved or damaged is found, whatever SQLite makes of it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "core/status.h"
#include "scan/database.h"
#include "scan/scan_row.h"

namespace tessera {

struct ScanSeal {
    struct Table {
        std::int64_t epoch = 0, rows = 0;
        std::uint64_t checksums = 0;  // their sum, modulo 2^64
    };
    std::int64_t checkpoint = 0;
    bool finished = false;  // the run that wrote it came to its end
    std::array<Table, kScanTableCount> tables;

    std::vector<std::uint8_t> Encode() const;
    static bool Decode(std::span<const std::uint8_t> bytes, ScanSeal& seal);
};

// The error for a file whose content is not sound: it names `tessera scan repair`.
Status DamagedScan(const std::string& path, const std::string& why);

// Owner thread only. Errors name the file, what is wrong and what to do.
class ScanFile {
  public:
    // A new file with one checkpoint, number 0: `meta` and nothing else. Refused where there is a
    // file already, or the journal of one. It appears at `path` whole or not at all.
    static Result<std::unique_ptr<ScanFile>> Create(const std::string& path,
                                                    std::span<const std::uint8_t> meta);
    // No scan, a newer version, or a header or schema that is not sound: refused. Two runs cannot
    // write into one file.
    static Result<std::unique_ptr<ScanFile>> OpenToRead(const std::string& path);
    static Result<std::unique_ptr<ScanFile>> OpenToWrite(const std::string& path);
    // What was not committed is not there; a new file without a checkpoint but its first goes.
    ~ScanFile();
    ScanFile(const ScanFile&) = delete;
    ScanFile& operator=(const ScanFile&) = delete;

    const std::string& path() const { return database_->path(); }
    const ScanSeal& seal() const { return seal_; }

    // Every row of a table by increasing key, checked against its checksum, and at the end their
    // number and sum against the seal. Ends early where `take` gives an error.
    Status Read(ScanTable table, const std::function<Status(const ScanRow&)>& take);
    // The data of one row of kState or kMeta; empty if there is none.
    Result<std::vector<std::uint8_t>> ReadOne(ScanTable table, std::int64_t key);

    // One checkpoint: Begin, any Put and Clear, Commit. An error leaves the file as it was before
    // Begin.
    Status Begin();
    Status Put(ScanTable table, std::int64_t key, std::span<const std::uint8_t> data);
    // All rows go; those that come are of a new epoch.
    Status Clear(ScanTable table);
    Status Commit(bool finished);
    // The file is as it was before Begin.
    void Rollback();
    // The file is one again, without journal beside it. At the end of writing, once.
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
    Status Abandon(const std::string& doing);
    Status Failed(const std::string& doing) const;

    bool fresh_ = false;  // made by Create
    // The file, held so that nobody else writes; outlives the database (closing it drops SQLite's
    // locks).
    int lock_ = -1;
    std::unique_ptr<Database> database_;
    ScanSeal seal_, next_;  // as committed, and as it will be
    std::array<Statements, kScanTableCount> statements_;
};

}  // namespace tessera
