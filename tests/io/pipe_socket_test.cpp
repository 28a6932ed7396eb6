// Frames that come through a named socket, from one sender after another.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

#include "io/file.h"
#include "io/pipe_source.h"
#include "io/pipe_stream.h"
#include "support/temp_folder.h"

namespace tessera {
namespace pipe_source_test {

/// Tries again until it holds, for at most 30 seconds: a fault fails the test, it never hangs it.
bool Eventually(const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!holds())
        if (std::chrono::steady_clock::now() > end) return false;
    return true;
}

class Socket : public testing::Test {
  protected:
    int Connect() const {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strcpy(address.sun_path, path.c_str());
        const int file = socket(AF_UNIX, SOCK_STREAM, 0);
        const auto connected = [&] {
            return connect(file, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
        };
        EXPECT_TRUE(Eventually(connected));
        return file;
    }
    static void Send(int file, const std::string& bytes) {
        EXPECT_EQ(send(file, bytes.data(), bytes.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(bytes.size()));
    }

    TempFolder folder;
    const std::string path = folder / "camera.sock";
};

TEST_F(Socket, AnotherSenderGoesOnWhereOneWent) {
    std::thread first([&] {
        const int file = Connect();
        Send(file, Greeting() + FrameOf(0) + FrameOf(1).substr(0, 100));
        close(file);
    });
    auto source = OpenPipeSource("pipe:" + path, {}, 30);
    first.join();
    ASSERT_TRUE(source.ok()) << source.message();
    const auto other = OpenPipeSource("pipe:" + path, {}, 0.1);
    ASSERT_FALSE(other.ok());
    EXPECT_NE(other.message().find("another program receives frames here"), std::string::npos);
    Frame frame;
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    const ReadResult gone = source.value()->Read(frame);
    EXPECT_EQ(gone.status, ReadStatus::kWait);
    EXPECT_EQ(gone.message,
              "pipe:" + path + ": the sender went within a frame, waiting for the next");
    const auto expect_left = [&](const std::string& greeting, const std::string& why) {
        const int file = Connect();
        Send(file, greeting);
        ReadResult read;
        EXPECT_TRUE(Eventually([&] {
            read = source.value()->Read(frame);
            return !read.message.empty();
        }));
        EXPECT_EQ(read.status, ReadStatus::kWait);
        EXPECT_NE(read.message.find(why), std::string::npos) << read.message;
        close(file);
    };
    expect_left("something else altogether", "is not a stream of frames");
    expect_left(Greeting("depth_scale: 5000\n"), "another camera than the first");
    const int last = Connect();
    Send(last, Greeting() + FrameOf(2));
    ASSERT_TRUE(Eventually([&] { return source.value()->Read(frame).status == ReadStatus::kOk; }));
    ExpectFrame(frame, 2);
    close(last);
    source.value().reset();
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Socket, TheWaitForASenderCanBeStopped) {
    const std::atomic<bool> stop{true};
    const auto source = OpenPipeSource("pipe:" + path, {}, 30, &stop);
    EXPECT_NE(source.message().find("stopped before a sender came"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Socket, ASocketThatAKilledProgramLeftIsTakenOver) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path.c_str());
    const int left = socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(bind(left, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    close(left);
    const auto source = OpenPipeSource("pipe:" + path, {}, 0.1);
    EXPECT_NE(source.message().find("nothing came"), std::string::npos) << source.message();
    const auto nowhere = OpenPipeSource("pipe:" + (folder / "absent/a"), {}, 0.1);
    EXPECT_NE(nowhere.message().find("absent/a: a socket cannot be made here"), std::string::npos);
    ASSERT_TRUE(WriteTextFile(folder / "mine", "text").ok());
    const auto file = OpenPipeSource("pipe:" + (folder / "mine"), {}, 0.1);
    EXPECT_FALSE(file.ok());
    EXPECT_TRUE(std::filesystem::exists(folder / "mine"));
}

}  // namespace pipe_source_test
}  // namespace tessera
