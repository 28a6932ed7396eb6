#include "io/growing_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "io/file.h"

namespace tessera {

GrowingFile::~GrowingFile() {
    if (file_ >= 0) close(file_);
}

Status GrowingFile::Failed() const {
    return Status::Error(path_ + ": cannot be written: " + WriteErrorText(errno));
}

Status GrowingFile::Open(const std::string& path) {
    if (file_ >= 0) close(file_);
    path_ = path;
    size_ = 0;
    file_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    return file_ >= 0 ? Status::Ok() : Failed();
}

Status GrowingFile::Append(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(file_, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            const Status status = Failed();
            (void)!ftruncate(file_, size_);
            (void)lseek(file_, size_, SEEK_SET);
            return status;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    size_ = lseek(file_, 0, SEEK_CUR);
    return Status::Ok();
}

Status GrowingFile::Sync() {
    return fsync(file_) == 0 || errno == EINVAL || errno == EROFS ? Status::Ok() : Failed();
}

}  // namespace tessera
