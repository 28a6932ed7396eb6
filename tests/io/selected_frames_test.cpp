#include "io/selected_frames.h"

#include <gtest/gtest.h>

#include <limits>

#include "io/counting_source.h"

namespace tessera {
namespace {

using Indices = std::vector<std::int64_t>;

// Indices of the frames returned, and -1 - i for a skipped frame i.
Indices ReadAll(const CountingSource::Options& options, const FrameSelection& selection) {
    SelectedFrames frames(std::make_unique<CountingSource>(options), selection);
    Indices indices;
    Frame frame;
    while (true) {
        const ReadResult result = frames.Next(frame);
        if (result.status == ReadStatus::kEnd) break;
        EXPECT_NE(result.status, ReadStatus::kError) << result.message;
        if (result.status == ReadStatus::kError) break;
        indices.push_back(result.status == ReadStatus::kOk
                              ? frame.index
                              : -1 - std::stoll(result.message.substr(6)));
    }
    EXPECT_EQ(frames.Next(frame).status, ReadStatus::kEnd);
    return indices;
}

TEST(SelectedFrames, TakesStartCountAndStrideWithAndWithoutSeeking) {
    for (bool seeks : {true, false})
        for (bool knows_count : {true, false}) {
            const CountingSource::Options source{
                .count = 10, .knows_count = knows_count, .seeks = seeks};
            EXPECT_EQ(ReadAll(source, {}), (Indices{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
            EXPECT_EQ(ReadAll(source, {.start = 2, .count = 3}), (Indices{2, 3, 4}));
            EXPECT_EQ(ReadAll(source, {.start = 1, .stride = 4}), (Indices{1, 5, 9}));
            EXPECT_EQ(ReadAll(source, {.start = 8, .count = 5}), (Indices{8, 9}));
            EXPECT_EQ(ReadAll(source, {.count = 0}), Indices{});
            EXPECT_EQ(ReadAll(source, {.stride = std::numeric_limits<std::int64_t>::max()}),
                      Indices{0});
        }
}

TEST(SelectedFrames, SkippedFramesCountAndKeepTheirPlace) {
    for (bool seeks : {true, false}) {
        const CountingSource::Options source{.count = 10, .seeks = seeks, .skipped = {2, 3}};
        EXPECT_EQ(ReadAll(source, {.count = 4}), (Indices{0, 1, -3, -4}));
        EXPECT_EQ(ReadAll(source, {.start = 1, .count = 3, .stride = 2}), (Indices{1, -4, 5}));
    }
}

TEST(StampOrder, RefusesALateFrameButNotAClockThatWasSetBack) {
    const auto accepted = [](const std::vector<double>& stamps_s) {
        StampOrder order;
        std::string text;
        for (const double stamp_s : stamps_s) text += order.Accepts(stamp_s) ? '+' : '-';
        return text;
    };
    EXPECT_EQ(accepted({1, 2, 2, 3}), "++++");
    EXPECT_EQ(accepted({1, 2, 1.5, 3, 4}), "++-++");
    EXPECT_EQ(accepted({1, 2, 1.5, 3, 2.5, 4}), "++-+-+");
    EXPECT_EQ(accepted({100, 101, 0, 1, 2, 3}), "++-+++");
    EXPECT_EQ(accepted({100, 5, 4, 3, 3.5, 4}), "+---++");
}

TEST(SelectedFrames, SkipsAFrameThatComesLate) {
    struct LateSource : CountingSource {
        using CountingSource::CountingSource;
        ReadResult Read(Frame& frame) override {
            const ReadResult read = CountingSource::Read(frame);
            frame.stamp_s = frame.index == 3 ? 0.5 : static_cast<double>(frame.index);
            return read;
        }
    };
    SelectedFrames frames(std::make_unique<LateSource>(CountingSource::Options{.count = 6}), {});
    Indices indices;
    Frame frame;
    for (int i = 0; i < 6; ++i) {
        const ReadResult result = frames.Next(frame);
        indices.push_back(result.status == ReadStatus::kOk ? frame.index : -1);
        if (result.status == ReadStatus::kSkip) {
            EXPECT_NE(result.message.find("frame 3: its time stamp, 0.500 s, is before that of the "
                                          "frame before it, 2.000 s"),
                      std::string::npos)
                << result.message;
        }
    }
    EXPECT_EQ(indices, (Indices{0, 1, 2, -1, 4, 5}));
}

TEST(SelectedFrames, RefusesImpossibleSelections) {
    const auto message = [](const FrameSelection& selection) {
        SelectedFrames frames(std::make_unique<CountingSource>(CountingSource::Options{}),
                              selection);
        Frame frame;
        const ReadResult result = frames.Next(frame);
        EXPECT_EQ(result.status, ReadStatus::kError);
        EXPECT_EQ(frames.Next(frame).status, ReadStatus::kError);
        return result.message;
    };
    EXPECT_EQ(message({.start = 10}), "counting: start frame 10 is past the end of its 10 frames");
    EXPECT_EQ(message({.start = -1}), "counting: start frame -1 is negative");
    EXPECT_EQ(message({.stride = 0}), "counting: stride 0 is less than 1");
    EXPECT_EQ(message({.count = -2}), "counting: -2 frames cannot be read");
}

// kWait is passed on, both between the selected frames and at one, and counts as no frame.
TEST(SelectedFrames, WaitingIsNoFrame) {
    auto source = std::make_unique<CountingSource>(CountingSource::Options{
        .count = 10, .knows_count = false, .seeks = false, .waits = {0, 3, 4}});
    SelectedFrames frames(std::move(source), {.start = 2, .count = 2, .stride = 2});
    std::string seen;
    Frame frame;
    for (ReadResult read; (read = frames.Next(frame)).status != ReadStatus::kEnd;)
        seen += read.status == ReadStatus::kWait ? read.message + ", "
                                                 : "frame " + std::to_string(frame.index) + ", ";
    EXPECT_EQ(seen, "before 0, frame 2, before 3, before 4, frame 4, ");
}

}  // namespace
}  // namespace tessera
