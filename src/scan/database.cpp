#include "scan/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include "scan/scan_row.h"

namespace tessera {

static_assert(kStepRow == SQLITE_ROW && kStepDone == SQLITE_DONE);

bool ScanAvailable() { return true; }

void DatabaseStatement::Finalizer::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

void DatabaseStatement::Bind(int parameter, std::int64_t value) {
    sqlite3_bind_int64(statement_.get(), parameter, value);
}

void DatabaseStatement::Bind(int parameter, std::span<const std::uint8_t> bytes) {
    static const std::uint8_t kNothing = 0;
    sqlite3_bind_blob64(statement_.get(), parameter, bytes.empty() ? &kNothing : bytes.data(),
                        bytes.size(), SQLITE_STATIC);
}

int DatabaseStatement::Step() { return sqlite3_step(statement_.get()); }

void DatabaseStatement::Reset() { sqlite3_reset(statement_.get()); }

std::int64_t DatabaseStatement::Number(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}

std::span<const std::uint8_t> DatabaseStatement::Bytes(int column) const {
    const auto* bytes =
        static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
    const int size = sqlite3_column_bytes(statement_.get(), column);
    return bytes != nullptr && size > 0 ? std::span(bytes, static_cast<std::size_t>(size))
                                        : std::span<const std::uint8_t>();
}

Result<std::unique_ptr<Database>> Database::Open(const std::string& path, Access access) {
    const int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                      (access == Access::kRead    ? SQLITE_OPEN_READONLY
                       : access == Access::kWrite ? SQLITE_OPEN_READWRITE
                                                  : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    sqlite3* handle = nullptr;
    const int opened = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
    std::unique_ptr<Database> database(new Database(path, handle));
    if (opened != SQLITE_OK) return database->Error("cannot be opened");
    sqlite3_busy_timeout(handle, 2000);
    sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxRowBytes));
    sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    if (Status status = database->Execute("PRAGMA cell_size_check=ON; PRAGMA mmap_size=0;");
        !status.ok())
        return status;
    return database;
}

Database::~Database() { sqlite3_close_v2(handle_); }

Status Database::Execute(const std::string& sql) {
    if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK)
        return Status::Ok();
    return Error("cannot be used");
}

Result<DatabaseStatement> Database::Prepare(const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(handle_, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
        return Error("cannot be read");
    return DatabaseStatement(statement);
}

Result<std::int64_t> Database::Number(const std::string& sql) {
    Result<DatabaseStatement> statement = Prepare(sql);
    if (!statement.ok()) return statement.status();
    if (statement.value().Step() != kStepRow) return Error("cannot be read");
    return statement.value().Number(0);
}

Status Database::Error(const std::string& doing) const {
    const int code = handle_ != nullptr ? sqlite3_errcode(handle_) & 0xff : SQLITE_NOMEM;
    const char* what =
        code == SQLITE_FULL
            ? "no space left on the device; free some space or choose another location"
            : (handle_ != nullptr ? sqlite3_errmsg(handle_) : "out of memory");
    return Status::Error(fmt::format("{}: {}: {}", path_, doing, what));
}

bool Database::needs_writer() const {
    const int code = sqlite3_extended_errcode(handle_);
    return code == SQLITE_READONLY_ROLLBACK || code == SQLITE_READONLY_RECOVERY;
}

bool Database::damaged() const {
    const int code = sqlite3_errcode(handle_) & 0xff;
    return code == SQLITE_CORRUPT || code == SQLITE_NOTADB || code == SQLITE_FORMAT ||
           code == SQLITE_ERROR || code == SQLITE_TOOBIG || code == SQLITE_MISMATCH ||
           code == SQLITE_SCHEMA;
}

}  // namespace tessera
