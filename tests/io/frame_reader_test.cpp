#include "io/frame_reader.h"

#include <gtest/gtest.h>

#include <new>
#include <set>

#include "io/counting_source.h"

namespace tessera {
namespace {

std::unique_ptr<FrameSource> Make(CountingSource::Options options) {
    return std::make_unique<CountingSource>(std::move(options));
}

TEST(FrameReader, GivesEveryFrameInOrder) {
    for (int capacity : {1, 2, 4}) {
        FrameReader reader(Make({.count = 500, .skipped = {7}}), {.start = 3, .stride = 2},
                           capacity);
        EXPECT_EQ(reader.info().frame_count, 500);
        Frame frame;
        for (std::int64_t index = 3; index < 500; index += 2) {
            const ReadResult result = reader.Next(frame);
            if (index == 7) {
                EXPECT_EQ(result.status, ReadStatus::kSkip);
                EXPECT_EQ(result.message, "frame 7");
                EXPECT_EQ(frame.index, 5);  // unchanged
                continue;
            }
            ASSERT_EQ(result.status, ReadStatus::kOk);
            ASSERT_EQ(frame.index, index);
            ASSERT_EQ(frame.depth_m, DepthImage(4, 3, static_cast<float>(index + 1)));
            EXPECT_GE(reader.decode_ms(), 0);
        }
        EXPECT_EQ(reader.Next(frame).status, ReadStatus::kEnd);
        EXPECT_EQ(reader.Next(frame).status, ReadStatus::kEnd);
    }
}

TEST(FrameReader, ReusesTheStorageOfItsFrames) {
    FrameReader reader(Make({.count = 200}), {}, 3);
    Frame frame;
    std::set<const float*> storages;
    while (reader.Next(frame).status == ReadStatus::kOk) storages.insert(frame.depth_m.data());
    EXPECT_LE(storages.size(), 4u);  // three in the ring and one of the caller
}

TEST(FrameReader, ReadsAtMostItsCapacityAhead) {
    std::atomic<std::int64_t> reads{0};
    FrameReader reader(Make({.count = 100, .reads = &reads}), {}, 2);
    Frame frame;
    for (std::int64_t taken = 0; taken < 50; ++taken) {
        EXPECT_LE(reads.load(), taken + 2);
        ASSERT_EQ(reader.Next(frame).status, ReadStatus::kOk);
    }
}

TEST(FrameReader, EndsAtAnyMoment) {
    for (int taken = 0; taken < 12; ++taken) {
        FrameReader reader(Make({.count = 8}), {}, 3);
        Frame frame;
        for (int i = 0; i < taken; ++i)
            EXPECT_EQ(reader.Next(frame).status, i < 8 ? ReadStatus::kOk : ReadStatus::kEnd);
    }
}

// Repeated many times, because it is a matter of timing whether the reader thread already waits for
// space in the full ring.
TEST(FrameReader, EndsWhileItsRingIsFull) {
    for (int round = 0; round < 100; ++round) {
        std::atomic<std::int64_t> reads{0};
        FrameReader reader(Make({.count = 100, .reads = &reads}), {}, 2);
        while (reads < 2) std::this_thread::yield();
        for (int i = 0; i < round; ++i) std::this_thread::yield();
    }
}

// The source blocks until go_on is set, so Next blocks too. A stop from another thread ends the
// wait.
TEST(FrameReader, AStopEndsAWaitingNext) {
    std::atomic<bool> reading{false}, go_on{false};
    FrameReader reader(Make({.before_read =
                                 [&](std::int64_t) {
                                     reading = true;
                                     reading.notify_all();
                                     go_on.wait(false);
                                 }}),
                       {});
    reading.wait(false);
    std::jthread stopper([&] {
        for (int i = 0; i < 1000; ++i) std::this_thread::yield();  // gives Next time to block
        reader.RequestStop();
    });
    Frame frame;
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kEnd);
    go_on = true;
    go_on.notify_all();
}

TEST(FrameReader, AStopDropsWhatWasReadAhead) {
    FrameReader reader(Make({.count = 100}), {}, 4);
    Frame frame;
    ASSERT_EQ(reader.Next(frame).status, ReadStatus::kOk);
    reader.RequestStop();
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kEnd);
}

TEST(FrameReader, ErrorsAreFinal) {
    FrameReader reader(Make({.count = 10}), {.start = 10});
    Frame frame;
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kError);
    EXPECT_EQ(reader.Next(frame).message,
              "counting: start frame 10 is past the end of its 10 frames");
}

TEST(FrameReader, AnExceptionInTheSourceIsAnError) {
    FrameReader reader(Make({.before_read =
                                 [](std::int64_t index) {
                                     if (index == 2) throw std::bad_alloc();
                                 }}),
                       {});
    Frame frame;
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kOk);
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kOk);
    const ReadResult result = reader.Next(frame);
    EXPECT_EQ(result.status, ReadStatus::kError);
    EXPECT_EQ(result.message, "counting: reading failed: std::bad_alloc");
}

TEST(FrameReader, PassesWaitingOn) {
    FrameReader reader(
        std::make_unique<CountingSource>(CountingSource::Options{.count = 2, .waits = {1}}), {}, 2);
    Frame frame;
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kOk);
    const ReadResult wait = reader.Next(frame);
    EXPECT_EQ(wait.status, ReadStatus::kWait);
    EXPECT_EQ(wait.message, "before 1");
    EXPECT_EQ(frame.index, 0);  // unchanged
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 1);
    EXPECT_EQ(reader.Next(frame).status, ReadStatus::kEnd);
}

}  // namespace
}  // namespace tessera
