// A disk between SQLite and the real one: it fails on demand, and it shows what the real one may
// hold after a power cut.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tessera::testing_support {

// What the disk does with one operation (a write, truncation, sync or removal).
enum class DiskFault {
    kFull,        // half of the write arrives, then the disk is full
    kWriteError,  // the same with an input/output error
    kGone         // this and everything later fails, reading too
};

// SQLite's default file system as long as it exists. One at a time; one thread.
class FaultyDisk {
  public:
    FaultyDisk();
    ~FaultyDisk();
    FaultyDisk(const FaultyDisk&) = delete;
    FaultyDisk& operator=(const FaultyDisk&) = delete;

    // Counted from the last call of Start.
    std::size_t operations() const { return log_.size(); }
    // Number of writes to one place of a file since then.
    std::size_t WritesAt(const std::string& file, std::int64_t offset) const;
    // Forgets faults and operations. What the folder's files hold counts as safe on disk.
    void Start(const std::string& folder);
    // The operation with this number fails; with `lasting`, all later ones fail, too.
    void FailAt(std::size_t operation, DiskFault fault, bool lasting);
    // Faults end; the next operations succeed.
    void Mend() { fails_at_ = kNever; }
    bool failed() const { return operations() > fails_at_; }

    // Fills `folder` with the files that the disk may hold if the power fails after `operations`
    // operations. Operations before a file's last sync are done. Each later one is done, left out,
    // or torn: of its sectors some are new, some old and some garbage. Writes may overtake each
    // other.
    void MakeAfterPowerCut(std::size_t operations, std::uint32_t seed,
                           const std::string& folder) const;

  private:
    enum class Kind { kWrite, kTruncate, kSync, kRemove };
    struct Operation {
        Kind kind;
        std::string file;
        std::int64_t offset = 0;  // of a truncation: the new size
        std::string bytes;
        bool safe = false;  // of a removal: synced with the folder
    };
    struct File;
    struct Methods;
    static constexpr std::size_t kNever = ~std::size_t{0};

    // Notes an operation and returns what SQLite is told.
    int Note(Operation operation);
    bool gone() const { return failed() && fault_ == DiskFault::kGone; }

    sqlite3_vfs* real_;
    sqlite3_vfs vfs_;
    std::map<std::string, std::string> safe_;  // file names and content at Start
    std::vector<Operation> log_;
    std::size_t fails_at_ = kNever;
    DiskFault fault_ = DiskFault::kFull;
    bool lasting_ = false;
};

}  // namespace tessera::testing_support
