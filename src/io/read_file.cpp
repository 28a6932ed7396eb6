#include "io/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tessera {
namespace {

struct Descriptor {
    int value = -1;
    ~Descriptor() {
        if (value >= 0) close(value);
    }
};

Status SystemError(const std::string& path) {
    const int code = errno;
    return Status::Error(fmt::format("{}: cannot be read: {}", path,
                                     code == ENOENT ? "no such file" : std::strerror(code)));
}

}  // namespace

Status ReadFileBytes(const std::string& path, std::size_t max_bytes,
                     std::vector<std::uint8_t>& bytes) {
    // Non-blocking, so that opening a pipe does not hang; it is refused below.
    const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.value < 0) return SystemError(path);
    struct stat about {};
    if (fstat(file.value, &about) != 0) return SystemError(path);
    if (!S_ISREG(about.st_mode)) return Status::Error(path + ": is not a regular file");
    const auto size = static_cast<std::size_t>(about.st_size);
    if (size > max_bytes)
        return Status::Error(
            fmt::format("{}: has {} bytes; at most {} bytes are read", path, size, max_bytes));
    bytes.resize(size);
    std::size_t done = 0;
    while (done < size) {
        const ssize_t count = read(file.value, bytes.data() + done, size - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return SystemError(path);
        if (count == 0) break;
        done += static_cast<std::size_t>(count);
    }
    bytes.resize(done);
    return Status::Ok();
}

}  // namespace tessera
