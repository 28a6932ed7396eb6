#include "core/queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace tessera {
namespace {

constexpr std::int64_t kItems = 1'000'000;

TEST(FifoQueue, RefusesWhenFullAndKeepsTheItem) {
    Wake wake;
    FifoQueue<std::unique_ptr<int>> queue(2, wake);
    EXPECT_TRUE(queue.TryPush(std::make_unique<int>(1)));
    EXPECT_TRUE(queue.TryPush(std::make_unique<int>(2)));
    auto third = std::make_unique<int>(3);
    EXPECT_FALSE(queue.TryPush(std::move(third)));
    ASSERT_NE(third, nullptr);
    EXPECT_EQ(queue.size(), 2u);
    std::unique_ptr<int> item;
    ASSERT_TRUE(queue.TryPop(item));
    EXPECT_EQ(*item, 1);
    EXPECT_TRUE(queue.TryPush(std::move(third)));
    ASSERT_TRUE(queue.TryPop(item));
    ASSERT_TRUE(queue.TryPop(item));
    EXPECT_EQ(*item, 3);
    EXPECT_FALSE(queue.TryPop(item));
    EXPECT_TRUE(queue.empty());
}

TEST(NewestQueue, TheOldestMakesRoom) {
    Wake wake;
    NewestQueue<int> queue(2, wake);
    EXPECT_EQ(queue.Push(1), std::nullopt);
    EXPECT_EQ(queue.Push(2), std::nullopt);
    EXPECT_EQ(queue.Push(3), 1);
    EXPECT_EQ(queue.Push(4), 2);
    EXPECT_EQ(queue.size(), 2u);
    int item = 0;
    ASSERT_TRUE(queue.TryPop(item));
    EXPECT_EQ(item, 3);
    ASSERT_TRUE(queue.TryPop(item));
    EXPECT_EQ(item, 4);
    EXPECT_FALSE(queue.TryPop(item));
}

// Both threads block when they have nothing to do: the consumer on an empty queue, the producer on
// a full one.
TEST(FifoQueue, AMillionItemsInOrderAcrossThreads) {
    Wake consumer, producer;
    FifoQueue<std::int64_t> queue(64, consumer);
    std::jthread thread([&] {
        for (std::int64_t i = 0; i < kItems; ++i)
            producer.Wait([&] { return queue.TryPush(std::int64_t{i}); });
    });
    std::int64_t wrong = 0;
    for (std::int64_t i = 0; i < kItems; ++i) {
        std::int64_t item = -1;
        consumer.Wait([&] { return queue.TryPop(item); });
        producer.Notify();
        wrong += item != i;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_TRUE(queue.empty());
}

// Every pushed item is either popped or dropped, both in order. The queue never holds more than its
// capacity plus one push in progress.
TEST(NewestQueue, AMillionItemsAreEachTakenOrDroppedOnce) {
    Wake consumer;
    NewestQueue<std::int64_t> queue(8, consumer);
    std::vector<std::uint8_t> seen(kItems);
    std::atomic<bool> done{false};
    std::atomic<std::size_t> largest{0};
    std::vector<std::int64_t> dropped;
    std::jthread thread([&] {
        for (std::int64_t i = 0; i < kItems; ++i) {
            if (const auto old = queue.Push(std::int64_t{i})) dropped.push_back(*old);
            largest.store(std::max(largest.load(), queue.size()));
        }
        done.store(true);
        consumer.Notify();
    });
    std::int64_t last = -1, disordered = 0;
    while (true) {
        std::int64_t item = -1;
        bool taken = false;
        consumer.Wait([&] { return (taken = queue.TryPop(item)) || done.load(); });
        if (!taken && !queue.TryPop(item)) break;
        disordered += item <= last;
        last = item;
        ++seen[static_cast<std::size_t>(item)];
    }
    thread.join();
    for (const std::int64_t item : dropped) ++seen[static_cast<std::size_t>(item)];
    EXPECT_EQ(disordered, 0);
    EXPECT_EQ(last, kItems - 1);
    EXPECT_TRUE(std::is_sorted(dropped.begin(), dropped.end()));
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), kItems);
    EXPECT_LE(largest.load(), 9u);
}

TEST(NewestQueue, ManyProducersLoseNothingThatIsNotCounted) {
    Wake consumer;
    NewestQueue<std::int64_t> queue(16, consumer);
    std::atomic<std::int64_t> dropped{0};
    std::atomic<int> running{4};
    std::vector<std::jthread> producers;
    for (int p = 0; p < 4; ++p)
        producers.emplace_back([&] {
            for (std::int64_t i = 0; i < kItems / 4; ++i)
                dropped += queue.Push(std::int64_t{i}).has_value();
            --running;
            consumer.Notify();
        });
    std::int64_t taken = 0;
    while (true) {
        std::int64_t item;
        bool got = false;
        consumer.Wait([&] { return (got = queue.TryPop(item)) || running.load() == 0; });
        if (!got && !queue.TryPop(item)) break;
        ++taken;
    }
    EXPECT_EQ(taken + dropped.load(), kItems);
}

}  // namespace
}  // namespace tessera
