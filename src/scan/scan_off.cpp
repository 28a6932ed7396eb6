// Stubs for database.cpp and compression.cpp in builds without SQLite or zstd. Opening a file
// always fails, so nothing else is ever called.
#include "scan/compression.h"
#include "scan/database.h"

namespace tessera {

bool ScanAvailable() { return false; }

void DatabaseStatement::Finalizer::operator()(sqlite3_stmt*) const {}
void DatabaseStatement::Bind(int, std::int64_t) {}
void DatabaseStatement::Bind(int, std::span<const std::uint8_t>) {}
int DatabaseStatement::Step() { return 0; }
void DatabaseStatement::Reset() {}
std::int64_t DatabaseStatement::Number(int) const { return 0; }
std::span<const std::uint8_t> DatabaseStatement::Bytes(int) const { return {}; }

Result<std::unique_ptr<Database>> Database::Open(const std::string& path, Access) {
    return Status::Error(path + ": " + kScanUnavailable);
}
Database::~Database() = default;
Status Database::Execute(const std::string&) { return Status::Error(kScanUnavailable); }
Result<std::int64_t> Database::Number(const std::string&) {
    return Status::Error(kScanUnavailable);
}
Result<DatabaseStatement> Database::Prepare(const std::string&) {
    return Status::Error(kScanUnavailable);
}
Status Database::Error(const std::string&) const { return Status::Error(kScanUnavailable); }
bool Database::needs_writer() const { return false; }
bool Database::damaged() const { return false; }

struct Compressor::Contexts {};
Compressor::Compressor() = default;
Compressor::~Compressor() = default;
void Compressor::Compress(std::span<const std::uint8_t>, std::vector<std::uint8_t>&) {}
bool Compressor::Decompress(std::span<const std::uint8_t>, std::span<std::uint8_t>) {
    return false;
}
std::uint64_t Compressor::ContentSize(std::span<const std::uint8_t>) { return 0; }

}  // namespace tessera
