// How long a frame takes through pipe: 640 x 480 pixels as they are, at 30 Hz over a Unix socket,
// from the sender's first byte to the decoded frame; and whether any is lost.
// Usage: pipe [SECONDS]
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "io/pipe_source.h"
#include "run/timings.h"

namespace {

using Clock = std::chrono::steady_clock;

template <class Number>
void Put(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

std::int64_t Now_us() {
    return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
        .count();
}

void SendAll(int file, const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
        const ssize_t done = send(file, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (done <= 0) return;
        sent += static_cast<std::size_t>(done);
    }
}

void Send(int file, int frames) {
    const std::string camera = "width: 640\nheight: 480\nfx: 525\nfy: 525\ncx: 320\ncy: 240\n";
    std::string bytes = "TESSERA1";
    Put(bytes, static_cast<std::uint32_t>(camera.size()));
    SendAll(file, bytes + camera);
    const std::string images(std::size_t{640} * 480 * 5, 7);
    auto next = Clock::now();
    for (int i = 0; i < frames; ++i) {
        std::this_thread::sleep_until(next += std::chrono::microseconds(33333));
        bytes.clear();
        Put(bytes, Now_us());
        Put(bytes, std::int32_t{640 * 480 * 2});
        Put(bytes, std::int32_t{640 * 480 * 3});
        SendAll(file, bytes + images);
    }
    close(file);
}

}  // namespace

int main(int argc, char** argv) {
    const int frames = 30 * (argc > 1 ? std::atoi(argv[1]) : 60);
    int files[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, files) != 0) return 2;
    std::jthread sender([&] { Send(files[1], frames); });
    auto source = tessera::OpenPipeSource("pipe:-", tessera::ByteStream(files[0]), {}, 5);
    if (!source.ok()) return fmt::print("{}\n", source.message()), 2;
    tessera::Frame frame;
    std::vector<double> latency_ms;
    while (true) {
        const tessera::ReadResult read = source.value()->Read(frame);
        if (read.status == tessera::ReadStatus::kEnd) break;
        if (read.status == tessera::ReadStatus::kOk)
            latency_ms.push_back(static_cast<double>(Now_us()) / 1000 - 1000 * frame.stamp_s);
    }
    const tessera::StageStatistics s = tessera::SummariseDurations(latency_ms);
    fmt::print("{} of {} frames; median {:.2f} ms, 95 % {:.2f} ms, at most {:.2f} ms\n",
               latency_ms.size(), frames, s.median_ms, s.p95_ms, s.max_ms);
    return 0;
}
