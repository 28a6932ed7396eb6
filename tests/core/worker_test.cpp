#include "core/worker.h"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <vector>

#include "core/notices.h"

namespace tessera {
namespace {

// Holds a worker in a job until it is opened.
class Gate {
  public:
    void Open() {
        open_.store(true);
        wake_.Notify();
    }
    void Pass() {
        reached_.store(true);
        wake_.Notify();
        wake_.Wait([this] { return open_.load(); });
    }
    void WaitUntilReached() {
        wake_.Wait([this] { return reached_.load(); });
    }

  private:
    Wake wake_;
    std::atomic<bool> open_{false}, reached_{false};
};

TEST(Worker, ProcessesAllJobsInOrderBeforeItFinishes) {
    std::vector<int> done;
    Worker<int> worker(4, [&](int& job) { done.push_back(job); });
    for (int i = 0; i < 1000; ++i) worker.PushOrWait(int{i});
    worker.Finish();
    std::vector<int> expected(1000);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(done, expected);
    EXPECT_TRUE(worker.idle());
    worker.Finish();  // a second time does nothing
}

TEST(Worker, AFullQueueRefusesAJobAndLeavesIt) {
    Gate gate;
    Worker<std::unique_ptr<int>> worker(1, [&](std::unique_ptr<int>&) { gate.Pass(); });
    ASSERT_TRUE(worker.TryPush(std::make_unique<int>(1)));
    gate.WaitUntilReached();
    ASSERT_TRUE(worker.TryPush(std::make_unique<int>(2)));
    auto third = std::make_unique<int>(3);
    EXPECT_FALSE(worker.TryPush(std::move(third)));
    ASSERT_NE(third, nullptr);
    EXPECT_EQ(worker.waiting(), 1u);
    EXPECT_FALSE(worker.idle());
    gate.Open();
    worker.WaitUntilIdle();
    EXPECT_TRUE(worker.TryPush(std::move(third)));
}

TEST(Worker, TheNewestJobWins) {
    Gate gate;
    std::vector<int> done;
    Worker<int, NewestQueue> worker(1, [&](int& job) {
        if (job == 1) gate.Pass();
        done.push_back(job);
    });
    worker.PushNewest(1);
    gate.WaitUntilReached();
    EXPECT_EQ(worker.PushNewest(2), std::nullopt);
    EXPECT_EQ(worker.PushNewest(3), 2);
    EXPECT_EQ(worker.PushNewest(4), 3);
    gate.Open();
    worker.WaitUntilIdle();
    EXPECT_EQ(done, (std::vector<int>{1, 4}));
}

TEST(Worker, AStopDropsTheJobsThatWait) {
    Gate gate;
    std::vector<int> done;
    std::vector<bool> finished;
    std::optional<Worker<int>> worker;
    worker.emplace(
        8,
        [&](int& job) {
            gate.Pass();
            done.push_back(job);
        },
        WorkerOptions{.end = [&](bool all) { finished.push_back(all); }});
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(worker->TryPush(int{i}));
    gate.WaitUntilReached();
    std::jthread opener([&] { gate.Open(); });
    worker.reset();
    EXPECT_LE(done.size(), 4u);
    EXPECT_EQ(done.front(), 0);
    EXPECT_EQ(finished, std::vector<bool>{false});
}

TEST(Worker, BeginsAndEndsOnItsOwnThread) {
    std::thread::id begun, worked, ended;
    bool finished = false;
    Worker<int> worker(1, [&](int&) { worked = std::this_thread::get_id(); },
                       {.begin = [&] { begun = std::this_thread::get_id(); },
                        .end =
                            [&](bool all) {
                                ended = std::this_thread::get_id();
                                finished = all;
                            }});
    worker.PushOrWait(1);
    worker.Finish();
    EXPECT_EQ(begun, worked);
    EXPECT_EQ(ended, worked);
    EXPECT_NE(worked, std::this_thread::get_id());
    EXPECT_TRUE(finished);
}

// Idle work is done between jobs, as long as there is some, and is not waited for at the end.
TEST(Worker, WorksIdlyWhileNoJobWaits) {
    Wake wake, done;
    std::atomic<int> left{5}, idled{0}, jobs{0};
    Worker<int> worker(4, [&](int&) { ++jobs; },
                       {.wake = &wake,
                        .has_idle_work = [&] { return left.load() > 0; },
                        .idle =
                            [&] {
                                --left;
                                ++idled;
                                done.Notify();
                            }});
    done.Wait([&] { return idled.load() == 5; });
    worker.PushOrWait(1);
    worker.WaitUntilIdle();
    EXPECT_EQ(jobs.load(), 1);
    EXPECT_EQ(idled.load(), 5);
    left.store(2);
    wake.Notify();
    done.Wait([&] { return idled.load() == 7; });
    worker.Finish();
}

TEST(Notices, AreTakenInOrderAndTheOldestGoFirst) {
    Wake wake;
    Notices notices(wake);
    EXPECT_EQ(notices.Take(), std::nullopt);
    notices.Tell("");  // not a message
    EXPECT_EQ(notices.Take(), std::nullopt);
    for (int i = 0; i < 300; ++i) notices.Tell(std::to_string(i));
    EXPECT_EQ(notices.Take(), "44");
    EXPECT_EQ(notices.Take(), "45");
}

}  // namespace
}  // namespace tessera
