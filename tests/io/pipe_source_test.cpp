#include "io/pipe_source.h"

#include <gtest/gtest.h>
#include <libdeflate.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/jpeg_encoder.h"
#include "io/pipe_stream.h"

namespace tessera {
namespace pipe_source_test {

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

}  // namespace pipe_source_test
}  // namespace tessera
