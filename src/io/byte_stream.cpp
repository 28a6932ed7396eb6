#include "io/byte_stream.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

namespace tessera {
namespace {

constexpr int kLongestWait_ms = 300;

Status SocketError(const std::string& path, const char* doing) {
    return Status::Error(fmt::format("{}: {}: {}", path, doing, std::strerror(errno)));
}

bool IsSocket(const std::string& path) {
    struct stat info {};
    return stat(path.c_str(), &info) == 0 && S_ISSOCK(info.st_mode);
}

bool SomeoneListens(const sockaddr_un& address) {
    const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const bool listens =
        connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
    close(probe);
    return listens;
}

}  // namespace

Result<ByteStream> ByteStream::Open(const std::string& path) {
    if (path == "-") return ByteStream(dup(STDIN_FILENO));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof(address.sun_path))
        return Status::Error(
            fmt::format("pipe:{}: give - for standard input, or a path of at most "
                        "{} bytes for a socket",
                        path, sizeof(address.sun_path) - 1));
    std::copy(path.begin(), path.end(), address.sun_path);
    ByteStream stream;
    stream.listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (stream.listener_ < 0) return SocketError(path, "a socket cannot be made");
    const auto* to = reinterpret_cast<const sockaddr*>(&address);
    int bound = bind(stream.listener_, to, sizeof(address));
    if (bound != 0 && errno == EADDRINUSE && IsSocket(path)) {
        // Left by a program that was killed.
        if (SomeoneListens(address))
            return Status::Error(path +
                                 ": another program receives frames here; choose another "
                                 "path");
        if (unlink(path.c_str()) == 0) bound = bind(stream.listener_, to, sizeof(address));
    }
    if (bound != 0) return SocketError(path, "a socket cannot be made here");
    stream.path_ = path;
    if (listen(stream.listener_, 1) != 0) return SocketError(path, "a socket cannot be made here");
    return stream;
}

ByteStream::ByteStream(ByteStream&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      listener_(std::exchange(other.listener_, -1)),
      file_(std::exchange(other.file_, -1)),
      filled_(other.filled_) {}

ByteStream::~ByteStream() {
    if (file_ >= 0) close(file_);
    if (listener_ >= 0) close(listener_);
    if (!path_.empty()) unlink(path_.c_str());
}

bool ByteStream::WaitReadable(int file, int most_ms) const {
    pollfd wanted{file, POLLIN, 0};
    return poll(&wanted, 1, most_ms) > 0;
}

ByteStream::Got ByteStream::Read(std::size_t count, std::vector<std::uint8_t>& bytes) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + std::chrono::milliseconds(kLongestWait_ms);
    const auto left_ms = [&] {
        return static_cast<int>(
            std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count());
    };
    if (file_ < 0) {
        if (listener_ < 0) return Got::kEnd;
        if (!WaitReadable(listener_, kLongestWait_ms)) return Got::kWait;
        file_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (file_ < 0) return Got::kWait;
    }
    bytes.resize(count);
    while (filled_ < count) {
        if (!WaitReadable(file_, std::max(0, left_ms()))) return Got::kWait;
        const ssize_t got = read(file_, bytes.data() + filled_, count - filled_);
        if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (got <= 0) return Got::kEnd;
        filled_ += static_cast<std::size_t>(got);
        if (filled_ < count && left_ms() <= 0) return Got::kWait;
    }
    filled_ = 0;
    return Got::kAll;
}

bool ByteStream::WaitsForSender() {
    if (file_ >= 0) close(file_);
    file_ = -1;
    filled_ = 0;
    return listener_ >= 0;
}

}  // namespace tessera
