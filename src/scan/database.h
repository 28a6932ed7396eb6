// SQLite, as far as scan files need it: the only place that knows the library. Errors name the
// file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/status.h"

struct sqlite3;
struct sqlite3_stmt;

namespace tessera {

// Whether this build has SQLite and zstd; if not, opening anything is refused with
// `ScanUnavailableText`.
bool ScanAvailable();
inline constexpr const char* kScanUnavailable =
    "this build has no scan files; install libsqlite3-dev and libzstd-dev and build again";

// One prepared statement; its parameters are numbered from 1, its columns from 0. Goes before its
// database.
class DatabaseStatement {
  public:
    DatabaseStatement() = default;
    DatabaseStatement(sqlite3_stmt* statement)
        : statement_(statement) {}  // NOLINT: implicit by design

    void Bind(int parameter, std::int64_t value);
    // Not copied: they must outlive Step.
    void Bind(int parameter, std::span<const std::uint8_t> bytes);
    // SQLite's result code: one of the three below, or an error.
    int Step();
    // Ready for other parameters.
    void Reset();
    std::int64_t Number(int column) const;
    std::span<const std::uint8_t> Bytes(int column) const;  // until the next Step or Reset

  private:
    struct Finalizer {
        void operator()(sqlite3_stmt* statement) const;
    };
    std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
};

inline constexpr int kStepRow = 100, kStepDone = 101;  // SQLITE_ROW, SQLITE_DONE

// Owner thread only.
class Database {
  public:
    enum class Access { kCreate, kRead, kWrite };

    // With settings against hostile files: no code from a schema runs, no row is larger than
    // kMaxRowBytes.
    static Result<std::unique_ptr<Database>> Open(const std::string& path, Access access);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    Status Execute(const std::string& sql);
    // The first column of the first row.
    Result<std::int64_t> Number(const std::string& sql);
    Result<DatabaseStatement> Prepare(const std::string& sql);
    const std::string& path() const { return path_; }
    // The library's words for the last error.
    Status Error(const std::string& doing) const;
    // The last error was of the file's content, not of reading or writing it.
    bool damaged() const;

  private:
    Database(std::string path, sqlite3* handle) : path_(std::move(path)), handle_(handle) {}

    std::string path_;
    sqlite3* handle_;
};

}  // namespace tessera
