#include "cuda/device.h"

#include <cstring>

#include "core/check.h"

namespace tessera::TESSERA_DEVICE {

void backend::Failed(const char* file, int line, const char* expression, const char* reason) {
    CheckFailed(file, line, expression, reason);
}

Stream::~Stream() {
    backend::Synchronise(handle_);
    backend::FreePinned(staging_);
    backend::DestroyStream(handle_);
}

// Returns the next free piece of pinned memory. Wait frees all pieces.
std::byte* Stream::Stage(std::size_t bytes) {
    constexpr std::size_t kAlignment = 256, kLeast = std::size_t{1} << 20;
    const std::size_t padded = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    if (staged_ + padded > staging_bytes_) {
        Wait();
        if (padded > staging_bytes_) {
            backend::FreePinned(staging_);
            staging_bytes_ = std::max(2 * padded, kLeast);
            staging_ = static_cast<std::byte*>(backend::AllocatePinned(staging_bytes_));
        }
    }
    std::byte* piece = staging_ + staged_;
    staged_ += padded;
    return piece;
}

void Stream::Upload(void* device, const void* host, std::size_t bytes) {
    // Copy in pieces, so that a whole map needs no pinned memory of its size.
    constexpr std::size_t kPiece = std::size_t{1} << 24;
    for (std::size_t at = 0; at < bytes; at += kPiece) {
        const std::size_t piece = std::min(kPiece, bytes - at);
        std::byte* staged = Stage(piece);
        std::memcpy(staged, static_cast<const std::byte*>(host) + at, piece);
        backend::Copy(static_cast<std::byte*>(device) + at, staged, piece, handle_);
    }
}

void Stream::Download(void* host, const void* device, std::size_t bytes) {
    if (bytes == 0) return;
    std::byte* staged = Stage(bytes);
    backend::Copy(staged, device, bytes, handle_);
    arrivals_.push_back({host, staged, bytes});
}

void Stream::Wait() {
    backend::Synchronise(handle_);
    for (const Arrival& arrival : arrivals_)
        std::memcpy(arrival.host, arrival.staged, arrival.bytes);
    arrivals_.clear();
    staged_ = 0;
}

void* DeviceMemory::Allocate(std::size_t bytes) {
    if (!HasRoom(bytes)) return nullptr;
    void* memory = backend::Allocate(bytes);
    if (memory != nullptr) used_bytes_ += bytes;
    return memory;
}

void DeviceMemory::Free(void* memory, std::size_t bytes) {
    backend::Free(memory);
    used_bytes_ -= bytes;
}

bool DeviceSorter::ReserveSelection(Stream& stream, int count) {
    const std::size_t bytes =
        backend::SelectIndices(nullptr, count, nullptr, nullptr, nullptr, 0, stream.handle());
    return scratch_.ReserveScratch(stream, bytes);
}

bool DeviceSorter::SortKeys(Stream& stream, const std::uint64_t* keys, std::uint64_t* sorted,
                            int count) {
    const std::size_t bytes = backend::SortKeys(keys, sorted, count, nullptr, 0, stream.handle());
    if (!scratch_.ReserveScratch(stream, bytes)) return false;
    backend::SortKeys(keys, sorted, count, scratch_.data(), bytes, stream.handle());
    return true;
}

bool DeviceSorter::SelectIndices(Stream& stream, const std::uint8_t* keep, int count,
                                 std::int32_t* indices, std::int32_t* selected) {
    const std::size_t bytes =
        backend::SelectIndices(keep, count, indices, selected, nullptr, 0, stream.handle());
    if (!scratch_.ReserveScratch(stream, bytes)) return false;
    backend::SelectIndices(keep, count, indices, selected, scratch_.data(), bytes, stream.handle());
    return true;
}

bool DeviceSorter::SumBefore(Stream& stream, const std::int32_t* counts, int count,
                             std::int32_t* sums) {
    const std::size_t bytes = backend::SumBefore(counts, count, sums, nullptr, 0, stream.handle());
    if (!scratch_.ReserveScratch(stream, bytes)) return false;
    backend::SumBefore(counts, count, sums, scratch_.data(), bytes, stream.handle());
    return true;
}

}  // namespace tessera::TESSERA_DEVICE
