#include "io/pipe_source.h"

#include <gtest/gtest.h>
#include <libdeflate.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <thread>

#include "io/file.h"
#include "io/jpeg_encoder.h"
#include "support/temp_folder.h"

namespace tessera {
namespace pipe_source_test {

constexpr int kWidth = 32, kHeight = 24;

template <typename Number>
void Put(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

std::string Greeting(const std::string& more = "") {
    const std::string camera = "width: 32\nheight: 24\nfx: 30\nfy: 30\ncx: 15.5\ncy: 11.5\n" + more;
    std::string bytes = "TESSERA1";
    Put(bytes, static_cast<std::uint32_t>(camera.size()));
    return bytes + camera;
}

std::uint16_t DepthAt(int number, int i) { return static_cast<std::uint16_t>(1000 + number + i); }

std::string RawDepth(int number) {
    std::string depth;
    for (int i = 0; i < kWidth * kHeight; ++i) Put(depth, DepthAt(number, i));
    return depth;
}

std::string RawColour(int number) {
    std::string colour;
    for (int i = 0; i < 3 * kWidth * kHeight; ++i) colour += static_cast<char>(number + i);
    return colour;
}

std::string FrameOf(int number, const std::string& depth, const std::string& colour) {
    std::string bytes;
    Put(bytes, std::int64_t{1000000} + 33333 * number);
    Put(bytes, static_cast<std::int32_t>(depth.size()));
    Put(bytes, static_cast<std::int32_t>(colour.size()));
    return bytes + depth + colour;
}
std::string FrameOf(int number) { return FrameOf(number, RawDepth(number), RawColour(number)); }

void ExpectFrame(const Frame& frame, int number) {
    EXPECT_NEAR(frame.stamp_s, 1 + 0.033333 * number, 1e-9);
    EXPECT_EQ(frame.stamp_s, frame.colour_stamp_s);
    ASSERT_EQ(frame.depth_m.width(), kWidth);
    for (int i = 0; i < kWidth * kHeight; ++i)
        ASSERT_FLOAT_EQ(frame.depth_m.data()[i], 0.001f * static_cast<float>(DepthAt(number, i)));
    if (frame.colour.empty()) return;
    const auto* colour = reinterpret_cast<const char*>(frame.colour.data());
    ASSERT_EQ(std::string(colour, 3 * frame.colour.size()), RawColour(number));
}

// The reader's end of a connection, and this end.
struct Ends {
    Ends() {
        int files[2];
        EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, files), 0);
        reader = files[0];
        sender = files[1];
    }
    void Send(const std::string& bytes) const {
        ASSERT_EQ(send(sender, bytes.data(), bytes.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(bytes.size()));
    }
    int reader = -1, sender = -1;
};

Result<std::unique_ptr<FrameSource>> Open(int file) {
    return OpenPipeSource("pipe:-", ByteStream(file), {}, 0.1);
}

TEST(PipeSource, GivesTheFramesAsSentAndThenEnds) {
    const Ends ends;
    std::thread sender([&] {
        ends.Send(Greeting());
        for (int number = 0; number < 5; ++number) ends.Send(FrameOf(number));
        ends.Send(FrameOf(5, RawDepth(5), ""));
        close(ends.sender);
    });
    auto source = Open(ends.reader);
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_TRUE(source.value()->info().live);
    EXPECT_EQ(source.value()->info().camera.fx, 30);
    EXPECT_EQ(source.value()->info().depth_units_per_m, 1000);
    Frame frame;
    for (int number = 0; number < 6; ++number) {
        ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
        EXPECT_EQ(frame.index, number);
        ExpectFrame(frame, number);
        EXPECT_EQ(frame.colour.empty(), number == 5);
    }
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kEnd);
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kEnd);
    sender.join();
}

// However the bytes are cut, and while they do not come the source says so at once.
TEST(PipeSource, WaitsForTheRestOfAFrame) {
    const Ends ends;
    ends.Send(Greeting());
    auto source = Open(ends.reader);
    ASSERT_TRUE(source.ok()) << source.message();
    const std::string bytes = FrameOf(3);
    Frame frame;
    for (const std::size_t cut : {std::size_t{5}, std::size_t{11}, bytes.size() - 30}) {
        ends.Send(bytes.substr(0, cut));
        EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kWait);
        ends.Send(bytes.substr(cut));
        ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
        ExpectFrame(frame, 3);
    }
    close(ends.sender);
}

TEST(PipeSource, CompressedImagesAndADamagedOne) {
    const Ends ends;
    std::string packed(5000, '\0');
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    const std::string depth = RawDepth(1);
    packed.resize(libdeflate_zlib_compress(compressor, depth.data(), depth.size(), packed.data(),
                                           packed.size()));
    libdeflate_free_compressor(compressor);
    std::vector<std::uint8_t> jpeg;
    ASSERT_TRUE(EncodeJpeg(ColourImage(kWidth, kHeight, {200, 100, 20}), 95, jpeg).ok());
    ends.Send(Greeting());
    ends.Send(FrameOf(0, "not zlib", ""));
    ends.Send(FrameOf(1, packed, std::string(jpeg.begin(), jpeg.end())));
    auto source = Open(ends.reader);
    ASSERT_TRUE(source.ok()) << source.message();
    Frame frame;
    const ReadResult damaged = source.value()->Read(frame);
    EXPECT_EQ(damaged.status, ReadStatus::kSkip);
    EXPECT_NE(damaged.message.find("pipe:-: frame 0: depth is damaged"), std::string::npos);
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m.data()[7], 0.001f * DepthAt(1, 7));
    EXPECT_NEAR(frame.colour.data()[0].r, 200, 3);
    close(ends.sender);
}

TEST(PipeSource, WhatIsNoStreamIsRefused) {
    const auto refusal = [](const std::string& bytes) {
        const Ends ends;
        ends.Send(bytes);
        close(ends.sender);
        const auto source = Open(ends.reader);
        return source.ok() ? std::string() : source.message();
    };
    EXPECT_NE(refusal("hello, this is no stream").find("pipe:-: is not a stream of frames"),
              std::string::npos);
    EXPECT_NE(refusal("").find("ended before a frame"), std::string::npos);
    EXPECT_NE(refusal(Greeting().substr(0, 40)).find("within a frame"), std::string::npos);
    EXPECT_NE(refusal(Greeting("fov: 3\n")).find("pipe:-: its camera: unknown key 'fov'"),
              std::string::npos);
    std::string large = "TESSERA1";
    Put(large, std::uint32_t{1} << 30);
    EXPECT_NE(refusal(large).find("is not a stream"), std::string::npos);
}

TEST(PipeSource, AFrameThatIsTooLargeEndsTheStream) {
    const Ends ends;
    std::string bytes = Greeting() + FrameOf(0);
    Put(bytes, std::int64_t{5});
    Put(bytes, std::int32_t{2000000000});
    Put(bytes, std::int32_t{0});
    ends.Send(bytes);
    auto source = Open(ends.reader);
    ASSERT_TRUE(source.ok()) << source.message();
    Frame frame;
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    const ReadResult large = source.value()->Read(frame);
    EXPECT_EQ(large.status, ReadStatus::kSkip);
    EXPECT_NE(large.message.find("2000000000 bytes of depth"), std::string::npos) << large.message;
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kEnd);
    close(ends.sender);
}

TEST(PipeSource, NothingCame) {
    const Ends ends;
    const auto source = Open(ends.reader);
    ASSERT_FALSE(source.ok());
    EXPECT_NE(source.message().find("nothing came for 0.1 s"), std::string::npos);
    close(ends.sender);
}

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
