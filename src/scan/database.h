// Wrapper for the parts of SQLite that scan files need. Only its source uses the library. Errors
// name the file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/status.h"

struct sqlite3;
struct sqlite3_stmt;

namespace tessera {

// Whether this build has SQLite and zstd. If not, opening anything fails with kScanUnavailable.
bool ScanAvailable();
inline constexpr const char* kScanUnavailable =
    "this build has no scan file support; install libsqlite3-dev and libzstd-dev and build again";

// One prepared statement. Parameters are numbered from 1, columns from 0. Must be destroyed before
// its database.
class DatabaseStatement {
  public:
    DatabaseStatement() = default;
    DatabaseStatement(sqlite3_stmt* statement)
        : statement_(statement) {}  // NOLINT: implicit by design

    void Bind(int parameter, std::int64_t value);
    // Does not copy the bytes; they must outlive Step.
    void Bind(int parameter, std::span<const std::uint8_t> bytes);
    // Returns SQLite's result code: kStepRow, kStepDone, or an error.
    int Step();
    // Prepares the statement for new parameters.
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

    // Opens the file with settings that protect against hostile files: no code from a schema runs,
    // and no row is larger than kMaxRowBytes.
    static Result<std::unique_ptr<Database>> Open(const std::string& path, Access access);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    Status Execute(const std::string& sql);
    // Returns the first column of the first row.
    Result<std::int64_t> Number(const std::string& sql);
    Result<DatabaseStatement> Prepare(const std::string& sql);
    const std::string& path() const { return path_; }
    // An error with SQLite's message for the last failure.
    Status Error(const std::string& doing) const;
    // True if the last error was that only a writer can make the file readable again.
    bool needs_writer() const;
    // True if the last error concerns the file's content, not reading or writing it.
    bool damaged() const;

  private:
    Database(std::string path, sqlite3* handle) : path_(std::move(path)), handle_(handle) {}

    std::string path_;
    sqlite3* handle_;
};

}  // namespace tessera
