#include "io/frame_reader.h"

#include <chrono>
#include <exception>
#include <utility>

#include "core/check.h"

namespace tessera {

FrameReader::FrameReader(std::unique_ptr<FrameSource> source, const FrameSelection& selection,
                         int capacity)
    : frames_(std::move(source), selection), info_(frames_.info()) {
    TESSERA_CHECK(capacity >= 1, "capacity {}", capacity);
    slots_.resize(static_cast<std::size_t>(capacity));
    thread_ = std::jthread([this] { ReadAhead(); });
}

FrameReader::~FrameReader() { RequestStop(); }

void FrameReader::RequestStop() {
    stop_.store(true);
    Signal();
}

void FrameReader::Signal() {
    events_.fetch_add(1);
    events_.notify_all();
}

// Reads the event counter before the condition, so that a change after the check ends the wait.
template <class Condition>
void FrameReader::WaitUntil(Condition condition) {
    while (true) {
        const std::uint32_t seen = events_.load();
        if (stop_.load() || condition()) return;
        events_.wait(seen);
    }
}

void FrameReader::ReadAhead() {
    for (std::uint64_t number = 0;; ++number) {
        WaitUntil([&] { return number - taken_.load() < slots_.size(); });
        if (stop_.load()) return;
        Slot& target = slot(number);
        const auto begin = std::chrono::steady_clock::now();
        target.result = ReadInto(target);
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - begin;
        target.decode_ms = taken.count();
        const ReadStatus status = target.result.status;  // once written_ advances, Next owns it
        written_.store(number + 1);
        Signal();
        if (status == ReadStatus::kEnd || status == ReadStatus::kError) return;
    }
}

ReadResult FrameReader::ReadInto(Slot& target) {
    try {
        return frames_.Next(target.frame);
    } catch (const std::exception& error) {  // out of memory; a source throws nothing else
        return {ReadStatus::kError, info_.name + ": reading failed: " + error.what()};
    }
}

ReadResult FrameReader::Next(Frame& frame) {
    const std::uint64_t number = taken_.load();
    WaitUntil([&] { return written_.load() > number; });
    if (stop_.load()) return {ReadStatus::kEnd, {}};
    Slot& source = slot(number);
    decode_ms_ = source.decode_ms;
    if (source.result.status == ReadStatus::kEnd || source.result.status == ReadStatus::kError)
        return source.result;  // stays in its slot: final
    if (source.result.status == ReadStatus::kOk) std::swap(frame, source.frame);
    ReadResult result = std::move(source.result);
    taken_.store(number + 1);
    Signal();
    return result;
}

}  // namespace tessera
