#include "viz/frame_images.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace tessera {
namespace {

// 100 frames of 640 x 480, each in one grey: its number. Frame 7 cannot be read.
class GreySource : public FrameSource {
  public:
    explicit GreySource(bool live = false) { info_.live = live; }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (next_ == 7) return {ReadStatus::kSkip, "bad"};
        frame.index = next_;
        frame.colour = ColourImage(640, 480);
        const auto grey = static_cast<std::uint8_t>(next_);
        for (std::size_t i = 0; i < frame.colour.size(); ++i)
            frame.colour.data()[i] = {grey, grey, grey};
        return {};
    }
    bool Seek(std::int64_t index) override {
        next_ = index;
        return index >= 0 && index < 100;
    }

  private:
    SourceInfo info_;
    std::int64_t next_ = 0;
};

Result<std::unique_ptr<FrameSource>> OpenGrey() {
    return std::unique_ptr<FrameSource>(std::make_unique<GreySource>());
}

FrameImages::Image Wait(FrameImages& images) {
    for (;;) {
        if (auto image = images.Take()) return *image;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

TEST(FrameImages, TheAskedFrameComesInASmallSize) {
    FrameImages images(OpenGrey);
    EXPECT_FALSE(images.Take());
    for (const std::int64_t index : {40, 3, 99}) {
        images.Request(index);
        const FrameImages::Image image = Wait(images);
        EXPECT_EQ(image.index, index);
        EXPECT_EQ(image.colour.width(), 320);
        EXPECT_EQ(image.colour.data()[0].r, index);
    }
}

TEST(FrameImages, WhatCannotBeReadIsEmpty) {
    FrameImages images(OpenGrey);
    for (const std::int64_t index : {7, 100, -1}) {
        images.Request(index);
        const FrameImages::Image image = Wait(images);
        EXPECT_EQ(image.index, index);
        EXPECT_TRUE(image.colour.empty());
    }
}

TEST(FrameImages, ASourceThatIsGoneIsOpenedOnce) {
    std::atomic<int> opened{0};
    FrameImages images([&]() -> Result<std::unique_ptr<FrameSource>> {
        ++opened;
        return Status::Error("gone");
    });
    EXPECT_EQ(opened, 0);  // not before it is needed
    for (const std::int64_t index : {0, 1}) {
        images.Request(index);
        EXPECT_TRUE(Wait(images).colour.empty());
    }
    EXPECT_EQ(opened, 1);
}

TEST(FrameImages, ACameraIsNotRead) {
    FrameImages images([]() -> Result<std::unique_ptr<FrameSource>> {
        return std::unique_ptr<FrameSource>(std::make_unique<GreySource>(true));
    });
    images.Request(0);
    EXPECT_TRUE(Wait(images).colour.empty());
}

}  // namespace
}  // namespace tessera
