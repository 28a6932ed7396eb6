// A background thread with a bounded lock-free queue of jobs.
#pragma once

#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "core/queue.h"

namespace tessera {

// Linux: lowers the priority of the calling thread only. If that is refused, nothing changes.
void LowerThreadPriority();

struct WorkerOptions {
    bool low_priority = false;
    // The thread sleeps here; outlives the worker. Null: a Wake of its own.
    Wake* wake = nullptr;
    // What else the thread does while no job waits: calls `idle` for as long as `has_idle_work`.
    // Whoever changes what `has_idle_work` depends on notifies `wake`.
    std::function<bool()> has_idle_work = {};
    std::function<void()> idle = {};
    // First and last call on the thread. `finished` is false after Stop.
    std::function<void()> begin = {};
    std::function<void(bool finished)> end = {};
};

// Processes jobs in order on a thread of its own. The type of the queue says what happens when it
// is full: a FifoQueue refuses the job, a NewestQueue drops the oldest. An idle thread sleeps.
//
// waiting and idle: any thread. All else: the owner's thread only. As a member it comes last, so
// that its thread ends before what the jobs use.
template <class Job, template <class> class Queue = FifoQueue>
class Worker {
  public:
    // Starts the thread. `process` runs on it.
    Worker(std::size_t capacity, std::function<void(Job&)> process, WorkerOptions options = {})
        : wake_(options.wake != nullptr ? *options.wake : own_wake_),
          jobs_(capacity, wake_),
          process_(std::move(process)),
          options_(std::move(options)),
          thread_([this] { Run(); }) {}
    ~Worker() { Stop(); }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    // With a FifoQueue. Returns false if it is full and leaves the job unchanged.
    bool TryPush(Job&& job) {
        unfinished_.fetch_add(1);
        if (jobs_.TryPush(std::move(job))) return true;
        unfinished_.fetch_sub(1);
        return false;
    }
    // With a FifoQueue. Waits for room.
    void PushOrWait(Job&& job) {
        owner_.Wait([&] { return TryPush(std::move(job)); });
    }
    // With a NewestQueue. Returns the job dropped to make room, if any.
    std::optional<Job> PushNewest(Job&& job) {
        unfinished_.fetch_add(1);
        std::optional<Job> dropped = jobs_.Push(std::move(job));
        if (dropped) unfinished_.fetch_sub(1);
        return dropped;
    }

    // Jobs that have not begun.
    std::size_t waiting() const { return jobs_.size(); }
    // No job waits or is being processed.
    bool idle() const { return unfinished_.load() == 0; }
    void WaitUntilIdle() {
        owner_.Wait([this] { return idle(); });
    }

    // Processes all jobs that wait, then joins.
    void Finish() { End(finish_); }
    // Joins after the current job. Those that wait are dropped.
    void Stop() { End(stop_); }

  private:
    void End(std::atomic<bool>& how) {
        if (!thread_.joinable()) return;
        how.store(true);
        wake_.Notify();
        thread_.join();
    }

    void Run() {
        if (options_.low_priority) LowerThreadPriority();
        if (options_.begin) options_.begin();
        while (RunOnce()) {
        }
        if (options_.end) options_.end(!stop_.load());
    }

    bool RunOnce() {
        std::optional<Job> job;
        bool finish = false;
        wake_.Wait([&] {
            // Read before the queue: what was pushed before Finish is found.
            finish = finish_.load();
            return stop_.load() || Take(job) || finish || HasIdleWork();
        });
        if (stop_.load() || (!job && finish)) return false;
        if (!job) {
            options_.idle();
            return true;
        }
        owner_.Notify();  // there is room
        process_(*job);
        unfinished_.fetch_sub(1);
        owner_.Notify();
        return true;
    }

    bool Take(std::optional<Job>& job) {
        job.emplace();
        if (!jobs_.TryPop(*job)) job.reset();
        return job.has_value();
    }
    bool HasIdleWork() const { return options_.has_idle_work && options_.has_idle_work(); }

    Wake own_wake_, owner_;
    Wake& wake_;
    Queue<Job> jobs_;
    std::atomic<std::size_t> unfinished_{0};
    std::atomic<bool> finish_{false}, stop_{false};
    const std::function<void(Job&)> process_;
    const WorkerOptions options_;
    std::jthread thread_;
};

}  // namespace tessera
