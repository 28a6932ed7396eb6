#include "io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>

namespace tessera {
namespace {

namespace fs = std::filesystem;

// Unique in this process and, through the process id, among all processes that write to the same
// folder.
std::string TemporaryName(const std::string& target) {
    static std::atomic<unsigned> counter{0};
    return fmt::format("{}.{}-{}.tmp", target, getpid(), counter.fetch_add(1));
}

std::string ResolveSymlinks(const std::string& path) {
    std::error_code error;
    if (!fs::is_symlink(path, error)) return path;
    const fs::path target = fs::weakly_canonical(path, error);
    return error ? path : target.string();
}

}  // namespace

std::string WriteErrorText(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "no space left on the device; free some space or choose another location";
        case EACCES:
        case EPERM:
        case EROFS: return "no write permission; choose another location";
        case ENOENT:
        case ENOTDIR: return "the folder does not exist; create it or choose another location";
        case EISDIR: return "is a folder; give a file name";
        default: return std::generic_category().message(error);
    }
}

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(ResolveSymlinks(path)) {
    struct stat info {};
    const bool exists = stat(target_.c_str(), &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        errno = EISDIR;
    } else if (exists && !S_ISREG(info.st_mode)) {
        file_ = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        temporary_ = TemporaryName(target_);
        file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file_ < 0) temporary_.clear();
        if (file_ >= 0 && exists) (void)!fchmod(file_, info.st_mode & 07777);  // same permissions
    }
    if (file_ < 0) Fail("cannot be written");
}

AtomicFile::~AtomicFile() {
    Close();
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::Fail(const char* what) {
    const int error = errno;
    if (!status_.ok()) return;
    status_ = Status::Error(fmt::format("{}: {}: {}", path_, what, WriteErrorText(error)));
}

void AtomicFile::Close() {
    if (file_ >= 0 && close(file_) != 0) Fail("cannot be written");
    file_ = -1;
}

void AtomicFile::Write(std::string_view bytes) {
    constexpr std::size_t kMostWaiting = std::size_t{64} << 10;
    if (!status_.ok()) return;
    if (waiting_.size() + bytes.size() > kMostWaiting) {
        WriteOut(waiting_);
        waiting_.clear();
    }
    if (bytes.size() > kMostWaiting)
        WriteOut(bytes);
    else
        waiting_ += bytes;
}

void AtomicFile::WriteOut(std::string_view bytes) {
    while (status_.ok() && !bytes.empty()) {
        const ssize_t written = write(file_, bytes.data(), bytes.size());
        if (written < 0) {
            if (errno != EINTR) Fail("cannot be written");
        } else {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
    }
}

Status AtomicFile::Commit(Sync sync) {
    WriteOut(waiting_);
    waiting_.clear();
    // Pipes and some devices do not support fsync; that is not an error.
    if (status_.ok() && sync == Sync::kNow && fsync(file_) != 0 && errno != EINVAL &&
        errno != EROFS)
        Fail("cannot be written");
    Close();
    if (status_.ok() && !temporary_.empty()) {
        if (rename(temporary_.c_str(), target_.c_str()) == 0) {
            temporary_.clear();
            if (sync == Sync::kNow) SyncFolderOf(target_);
        } else {
            Fail("cannot be replaced");
        }
    }
    return status_;
}

Status WriteTextFile(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.Write(text);
    return file.Commit();
}

void SyncFolderOf(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    const int file =
        open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) return;
    (void)fsync(file);
    close(file);
}

Status PrepareOutputFolder(const std::string& path) {
    std::error_code error;
    fs::create_directories(path, error);
    std::error_code ignored;
    if (fs::exists(path, ignored) && !fs::is_directory(path, ignored))
        return Status::Error(path + ": is a file; give an output folder");
    if (error)
        return Status::Error(
            fmt::format("{}: cannot create the folder: {}", path, WriteErrorText(error.value())));
    const std::string probe = TemporaryName((fs::path(path) / "probe").string());
    const Status status = WriteTextFile(probe, std::string(4096, ' '));
    unlink(probe.c_str());
    if (status.ok()) return status;
    return Status::Error(
        fmt::format("{}: cannot write to the folder ({}); choose another one with --out", path,
                    status.message()));
}

}  // namespace tessera
