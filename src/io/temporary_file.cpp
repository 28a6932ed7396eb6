#include "io/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "io/file.h"

namespace tessera {

std::string TemporaryFolder() {
    const char* folder = std::getenv("TMPDIR");
    return folder != nullptr && *folder != '\0' ? folder : "/var/tmp";
}

Result<std::shared_ptr<TemporaryFile>> TemporaryFile::CreateBeside(const std::string& beside_path) {
    std::string name = beside_path + ".XXXXXX";
    const int file = ::mkostemp(name.data(), O_CLOEXEC);
    if (file < 0)
        return Status::Error(fmt::format("{}: cannot create a temporary file next to it: {}",
                                         beside_path, WriteErrorText(errno)));
    ::unlink(name.c_str());
    return std::shared_ptr<TemporaryFile>(new TemporaryFile(file));
}

TemporaryFile::~TemporaryFile() { ::close(file_); }

Status TemporaryFile::Write(std::span<const std::uint8_t> bytes, std::uint64_t offset) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0)
            return Status::Error("cannot be written: " +
                                 WriteErrorText(written < 0 ? errno : ENOSPC));
        bytes = bytes.subspan(static_cast<std::size_t>(written));
        offset += static_cast<std::uint64_t>(written);
    }
    return Status::Ok();
}

Status TemporaryFile::Read(std::span<std::uint8_t> bytes, std::uint64_t offset) const {
    while (!bytes.empty()) {
        const ssize_t got = ::pread(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            return Status::Error("cannot be read: " + WriteErrorText(got < 0 ? errno : EIO));
        bytes = bytes.subspan(static_cast<std::size_t>(got));
        offset += static_cast<std::uint64_t>(got);
    }
    return Status::Ok();
}

void TemporaryFile::Discard(std::uint64_t offset, std::uint64_t count) {
    ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset),
                static_cast<off_t>(count));
}

std::uint64_t TemporaryFile::FreeOnDisk() const {
    struct statvfs info {};
    if (::fstatvfs(file_, &info) != 0) return 0;
    return static_cast<std::uint64_t>(info.f_bavail) * info.f_frsize;
}

}  // namespace tessera
