#include "scan/faulty_disk.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace tessera::testing_support {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSectorBytes = 512;

std::string NameOf(const char* path) { return fs::path(path).filename().string(); }

void PutBytes(std::string& content, std::int64_t offset, const std::string& bytes) {
    const std::size_t at = static_cast<std::size_t>(offset);
    content.resize(std::max(content.size(), at + bytes.size()));
    std::copy(bytes.begin(), bytes.end(), content.begin() + offset);
}

// Of each sector of the new bytes: the new, the old, or garbage.
std::string Torn(const std::string& content, std::int64_t offset, const std::string& bytes,
                 std::mt19937& random) {
    std::string torn = bytes;
    for (std::size_t i = 0; i < torn.size(); i += kSectorBytes) {
        const std::uint32_t what = random() % 4;
        for (std::size_t k = i; k < std::min(i + kSectorBytes, torn.size()); ++k) {
            const std::size_t at = static_cast<std::size_t>(offset) + k;
            if (what == 0) torn[k] = at < content.size() ? content[at] : '\0';
            if (what == 1) torn[k] = static_cast<char>(random());
        }
    }
    return torn;
}

}  // namespace

// What SQLite sees as an open file; the real one lies behind it in memory.
struct FaultyDisk::File {
    sqlite3_file base;
    FaultyDisk* disk;
    std::string* name;

    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

struct FaultyDisk::Methods {
    static File& Of(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }
    static FaultyDisk& Of(sqlite3_vfs* vfs) { return *static_cast<FaultyDisk*>(vfs->pAppData); }
    static const sqlite3_io_methods& Real(sqlite3_file* file) { return *Of(file).real()->pMethods; }

    static int Close(sqlite3_file* file) {
        delete Of(file).name;
        return Real(file).xClose(Of(file).real());
    }
    static int Read(sqlite3_file* file, void* to, int bytes, sqlite3_int64 offset) {
        if (Of(file).disk->gone()) return SQLITE_IOERR_READ;
        return Real(file).xRead(Of(file).real(), to, bytes, offset);
    }
    static int Write(sqlite3_file* file, const void* from, int bytes, sqlite3_int64 offset) {
        const std::string content(static_cast<const char*>(from), static_cast<std::size_t>(bytes));
        const int told = Of(file).disk->Note({Kind::kWrite, *Of(file).name, offset, content});
        const int arrives = told == SQLITE_OK ? bytes : Of(file).disk->gone() ? 0 : bytes / 2;
        const int done = Real(file).xWrite(Of(file).real(), from, arrives, offset);
        return told == SQLITE_OK ? done : told;
    }
    static int Truncate(sqlite3_file* file, sqlite3_int64 size) {
        const int told = Of(file).disk->Note({Kind::kTruncate, *Of(file).name, size, ""});
        return told == SQLITE_OK ? Real(file).xTruncate(Of(file).real(), size) : told;
    }
    // The real disk is not synced: only our own record of it counts.
    static int Sync(sqlite3_file* file, int) {
        return Of(file).disk->Note({Kind::kSync, *Of(file).name, 0, ""});
    }
    static int FileSize(sqlite3_file* file, sqlite3_int64* size) {
        if (Of(file).disk->gone()) return SQLITE_IOERR_FSTAT;
        return Real(file).xFileSize(Of(file).real(), size);
    }
    static int Remove(sqlite3_vfs* vfs, const char* path, int sync) {
        const int told = Of(vfs).Note({Kind::kRemove, NameOf(path), 0, "", sync != 0});
        return told == SQLITE_OK ? Of(vfs).real_->xDelete(Of(vfs).real_, path, 0) : told;
    }
    static int Open(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* out) {
        file->pMethods = nullptr;
        if (Of(vfs).gone()) return SQLITE_CANTOPEN;
        const int opened = Of(vfs).real_->xOpen(Of(vfs).real_, path, Of(file).real(), flags, out);
        if (opened != SQLITE_OK) return opened;
        Of(file).disk = &Of(vfs);
        Of(file).name = new std::string(path != nullptr ? NameOf(path) : "");
        // The rest goes to the real disk.
        static const sqlite3_io_methods methods{
            2,
            Close,
            Read,
            Write,
            Truncate,
            Sync,
            FileSize,
            [](sqlite3_file* f, int lock) { return Real(f).xLock(Of(f).real(), lock); },
            [](sqlite3_file* f, int lock) { return Real(f).xUnlock(Of(f).real(), lock); },
            [](sqlite3_file* f, int* is) { return Real(f).xCheckReservedLock(Of(f).real(), is); },
            [](sqlite3_file* f, int op, void* a) {
                return Real(f).xFileControl(Of(f).real(), op, a);
            },
            [](sqlite3_file* f) { return Real(f).xSectorSize(Of(f).real()); },
            [](sqlite3_file* f) { return Real(f).xDeviceCharacteristics(Of(f).real()); },
            [](sqlite3_file* f, int page, int bytes, int extend, void volatile** at) {
                return Real(f).xShmMap(Of(f).real(), page, bytes, extend, at);
            },
            [](sqlite3_file* f, int offset, int n, int lock) {
                return Real(f).xShmLock(Of(f).real(), offset, n, lock);
            },
            [](sqlite3_file* f) { Real(f).xShmBarrier(Of(f).real()); },
            [](sqlite3_file* f, int remove) { return Real(f).xShmUnmap(Of(f).real(), remove); },
            nullptr,
            nullptr};
        file->pMethods = &methods;
        return SQLITE_OK;
    }
};

FaultyDisk::FaultyDisk() : real_(sqlite3_vfs_find(nullptr)), vfs_(*real_) {
    vfs_.szOsFile = static_cast<int>(sizeof(File)) + real_->szOsFile;
    vfs_.pNext = nullptr;
    vfs_.zName = "faulty";
    vfs_.pAppData = this;
    vfs_.xOpen = Methods::Open;
    vfs_.xDelete = Methods::Remove;
    // The rest is the real one's, which finds its own data in its own object.
    vfs_.xAccess = [](sqlite3_vfs* vfs, const char* path, int flags, int* out) {
        return Methods::Of(vfs).real_->xAccess(Methods::Of(vfs).real_, path, flags, out);
    };
    vfs_.xFullPathname = [](sqlite3_vfs* vfs, const char* path, int bytes, char* out) {
        return Methods::Of(vfs).real_->xFullPathname(Methods::Of(vfs).real_, path, bytes, out);
    };
    sqlite3_vfs_register(&vfs_, 1);
}

FaultyDisk::~FaultyDisk() { sqlite3_vfs_unregister(&vfs_); }

void FaultyDisk::Start(const std::string& folder) {
    log_.clear();
    Mend();
    safe_.clear();
    for (const auto& entry : fs::directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        safe_[NameOf(entry.path().c_str())] = {std::istreambuf_iterator<char>(file), {}};
    }
}

std::size_t FaultyDisk::WritesAt(const std::string& file, std::int64_t offset) const {
    return static_cast<std::size_t>(std::ranges::count_if(log_, [&](const Operation& operation) {
        return operation.kind == Kind::kWrite && operation.file == file &&
               operation.offset == offset;
    }));
}

void FaultyDisk::FailAt(std::size_t operation, DiskFault fault, bool lasting) {
    fails_at_ = operation;
    fault_ = fault;
    lasting_ = lasting;
}

int FaultyDisk::Note(Operation operation) {
    const std::size_t number = log_.size();
    const Kind kind = operation.kind;
    log_.push_back(std::move(operation));
    const bool forever = lasting_ || fault_ == DiskFault::kGone;
    if (fails_at_ == kNever || (forever ? number < fails_at_ : number != fails_at_))
        return SQLITE_OK;
    switch (kind) {
        case Kind::kWrite: return fault_ == DiskFault::kFull ? SQLITE_FULL : SQLITE_IOERR_WRITE;
        case Kind::kTruncate: return SQLITE_IOERR_TRUNCATE;
        case Kind::kSync: return SQLITE_IOERR_FSYNC;
        case Kind::kRemove: return SQLITE_IOERR_DELETE;
    }
    return SQLITE_IOERR;
}

void FaultyDisk::MakeAfterPowerCut(std::size_t operations, std::uint32_t seed,
                                   const std::string& folder) const {
    std::mt19937 random(seed);
    std::map<std::string, std::size_t> synced;  // each file's last sync
    for (std::size_t i = 0; i < operations; ++i)
        if (log_[i].kind == Kind::kSync) synced[log_[i].file] = i;
    std::map<std::string, std::string> files = safe_;
    for (std::size_t i = 0; i < operations; ++i) {
        const Operation& operation = log_[i];
        const auto sync = synced.find(operation.file);
        const bool safe = operation.safe || (sync != synced.end() && i <= sync->second);
        const std::uint32_t what = safe ? 3 : random() % 4;
        if (what == 0 || operation.kind == Kind::kSync) continue;
        if (operation.kind == Kind::kRemove) {
            files.erase(operation.file);
            continue;
        }
        std::string& content = files[operation.file];
        if (operation.kind == Kind::kTruncate)
            content.resize(static_cast<std::size_t>(operation.offset));
        else
            PutBytes(content, operation.offset,
                     what == 1 ? Torn(content, operation.offset, operation.bytes, random)
                               : operation.bytes);
    }
    fs::remove_all(folder);
    fs::create_directories(folder);
    for (const auto& [name, content] : files)
        std::ofstream(fs::path(folder) / name, std::ios::binary) << content;
}

}  // namespace tessera::testing_support
