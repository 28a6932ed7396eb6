#include "run/kept_source.h"

#include <gtest/gtest.h>

#include "io/counting_source.h"

namespace tessera {
namespace {

struct Opened {
    explicit Opened(bool seeks)
        : source([this, seeks](const RunConfig&) -> Result<std::unique_ptr<FrameSource>> {
              ++times;
              return std::unique_ptr<FrameSource>(
                  std::make_unique<CountingSource>(CountingSource::Options{.seeks = seeks}));
          }) {}

    void ReadsItsBeginning(const RunConfig& config) {
        const Result<FrameSource*> with = source.With(config);
        ASSERT_TRUE(with.ok()) << with.message();
        Frame frame;
        for (std::int64_t i = 0; i < 3; ++i) {
            ASSERT_EQ(with.value()->Read(frame).status, ReadStatus::kOk);
            EXPECT_EQ(frame.index, i);
        }
    }

    int times = 0;
    KeptSource source;
};

TEST(KeptSource, OpensAgainOnlyForOtherSettings) {
    Opened opened(true);
    RunConfig config;
    for (int i = 0; i < 3; ++i) opened.ReadsItsBeginning(config);
    EXPECT_EQ(opened.times, 1);
    config.source.colour_shift_px.x() = 2;
    for (int i = 0; i < 2; ++i) opened.ReadsItsBeginning(config);
    EXPECT_EQ(opened.times, 2);
    config.source.camera = PinholeCamera{};
    opened.ReadsItsBeginning(config);
    EXPECT_EQ(opened.times, 3);
    EXPECT_NE(opened.source.Take(), nullptr);
}

TEST(KeptSource, OpensAgainWhatCannotSeek) {
    Opened opened(false);
    for (int i = 0; i < 3; ++i) opened.ReadsItsBeginning({});
    EXPECT_EQ(opened.times, 3);
}

}  // namespace
}  // namespace tessera
