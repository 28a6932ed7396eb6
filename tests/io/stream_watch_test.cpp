#include "io/stream_watch.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(StreamWatch, TellsOfEachSilenceOnce) {
    StreamWatch watch(10);
    EXPECT_EQ(watch.NewSilence(10.9), "");
    EXPECT_EQ(watch.NewSilence(11), "no images for 1.0 s");
    EXPECT_EQ(watch.NewSilence(15), "");
    watch.Heard(true, 15);
    watch.Heard(false, 15.5);
    EXPECT_EQ(watch.NewSilence(15.6), "");
    EXPECT_EQ(watch.NewSilence(16.2), "no depth images for 1.2 s");
}

TEST(StreamWatch, NamesTheStreamThatIsSilent) {
    StreamWatch watch(0);
    watch.Heard(true, 3);
    EXPECT_DOUBLE_EQ(watch.Silence_s(3.5), 3.5);
    EXPECT_EQ(watch.NewSilence(3.5), "no colour images for 3.5 s");
    watch.Heard(false, 4);
    EXPECT_DOUBLE_EQ(watch.Silence_s(4.5), 1.5);
}

TEST(StreamWatch, TimeInWhichNobodyListensIsNoSilence) {
    StreamWatch watch(0);
    watch.Heard(true, 10);
    watch.Heard(false, 10);
    watch.NotHeard(5);
    watch.Heard(true, 15.01);
    EXPECT_NEAR(watch.Silence_s(15.01), 0.01, 1e-9);
    EXPECT_EQ(watch.NewSilence(15.01), "");
    EXPECT_EQ(watch.NewSilence(16.1), "no images for 1.1 s");
}

}  // namespace
}  // namespace tessera
