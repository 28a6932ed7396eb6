#include "core/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

namespace tessera {
namespace {

Status CannotRead(const std::string& path, const std::string& why) {
    return Status::Error(path + ": cannot be read: " + why);
}

Status SystemError(const std::string& path) {
    const int code = errno;
    if (code == ENOENT || code == ENOTDIR) return Status::Error(path + ": no such file");
    return CannotRead(path,
                      code == EACCES ? "no permission" : std::generic_category().message(code));
}

template <class Bytes>
Status ReadInto(const std::string& path, std::size_t max_bytes, Bytes& bytes) {
    const Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    const std::uint64_t size = file.value().size();
    if (size > max_bytes)
        return Status::Error(
            fmt::format("{}: has {} bytes; at most {} bytes are read", path, size, max_bytes));
    try {
        bytes.resize(size);
    } catch (const std::bad_alloc&) {
        return Status::Error(path + ": does not fit in memory");
    }
    return file.value().ReadAt(0, {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

Result<InputFile> InputFile::Open(const std::string& path) {
    // Non-blocking, so that opening a pipe does not wait for a writer.
    const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0) return SystemError(path);
    InputFile file(path, descriptor);
    struct stat about {};
    if (fstat(descriptor, &about) != 0) return SystemError(path);
    if (S_ISDIR(about.st_mode)) return Status::Error(path + ": is a folder; give a file");
    if (!S_ISREG(about.st_mode))
        return Status::Error(path + ": is a pipe or a device; give a regular file");
    file.size_ = static_cast<std::uint64_t>(about.st_size);
    return file;
}

InputFile::~InputFile() {
    if (file_ >= 0) close(file_);
}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)), size_(other.size_) {}

InputFile& InputFile::operator=(InputFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(file_, other.file_);
    std::swap(size_, other.size_);
    return *this;
}

Status InputFile::ReadAt(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
    while (!bytes.empty()) {
        const ssize_t got = pread(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return SystemError(path_);
        if (got == 0) return CannotRead(path_, "it became shorter meanwhile");
        bytes = bytes.subspan(static_cast<std::size_t>(got));
        offset += static_cast<std::uint64_t>(got);
    }
    return Status::Ok();
}

Result<std::string> ReadWholeFile(const std::string& path, std::size_t max_bytes) {
    std::string bytes;
    if (Status status = ReadInto(path, max_bytes, bytes); !status.ok()) return status;
    return bytes;
}

Status ReadFileBytes(const std::string& path, std::size_t max_bytes,
                     std::vector<std::uint8_t>& bytes) {
    return ReadInto(path, max_bytes, bytes);
}

}  // namespace tessera
