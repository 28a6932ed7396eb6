#include "viz/background_job.h"

#include <gtest/gtest.h>

#include <semaphore>

namespace tessera {
namespace {

using State = BackgroundJob::State;

// Until the thread has told something new.
void Take(BackgroundJob& job) {
    while (!job.Update()) std::this_thread::yield();
}

TEST(BackgroundJob, TellsWhatItDoesAndWhatItMade) {
    BackgroundJob job;
    EXPECT_FALSE(job.offered());
    job.Start();
    EXPECT_EQ(job.state(), State::kNone);
    std::binary_semaphore may_go_on(0);
    job.Offer([&](const BackgroundJob::Progress& progress) -> Result<std::string> {
        EXPECT_TRUE(progress("paint", 0.25));
        may_go_on.acquire();
        return std::string("a picture");
    });
    EXPECT_TRUE(job.offered());
    EXPECT_FALSE(job.Update());
    job.Start();
    EXPECT_EQ(job.state(), State::kRunning);
    Take(job);
    EXPECT_STREQ(job.step(), "paint");
    while (job.share() != 0.25) Take(job);
    EXPECT_FALSE(job.Update());  // nothing new
    job.Start();                 // once is enough
    may_go_on.release();
    Take(job);
    EXPECT_EQ(job.state(), State::kDone);
    EXPECT_EQ(job.text(), "a picture");
    EXPECT_FALSE(job.Update());
    job.Dismiss();
    EXPECT_EQ(job.state(), State::kNone);
}

TEST(BackgroundJob, AnErrorIsKept) {
    BackgroundJob job;
    job.Offer([](const auto&) -> Result<std::string> { return Status::Error("no paint"); });
    job.Start();
    Take(job);
    EXPECT_EQ(job.state(), State::kFailed);
    EXPECT_EQ(job.text(), "no paint");
}

Result<std::string> PaintForEver(const BackgroundJob::Progress& progress) {
    while (progress("paint", 0.5)) std::this_thread::yield();
    return Status::Error("cancelled");
}

TEST(BackgroundJob, IsCancelledAndBegunAgain) {
    BackgroundJob job;
    job.Offer(PaintForEver);
    for (int i = 0; i < 3; ++i) {
        job.Start();
        EXPECT_EQ(job.state(), State::kRunning);
        job.Dismiss();  // not while it runs
        EXPECT_EQ(job.state(), State::kRunning);
        job.Cancel();
        while (job.state() == State::kRunning) Take(job);
        EXPECT_EQ(job.state(), State::kCancelled);
    }
}

TEST(BackgroundJob, EndsWithItsOwner) {
    BackgroundJob job;
    job.Offer(PaintForEver);
    job.Start();
    Take(job);
}

}  // namespace
}  // namespace tessera
