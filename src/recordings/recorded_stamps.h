// Time stamps of recordings whose format may lack them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "recordings/recording.h"

namespace tessera {

// Pairs at index / fps.
std::vector<RecordedPair> EvenlyStamped(std::size_t count, double fps);

// Whether each depth stamp is finite and above the one before.
bool DepthStampsIncrease(std::span<const RecordedPair> pairs);

// From the median distance of depth stamps, which must increase. Fewer than two pairs: `otherwise`.
double MedianFps(std::span<const RecordedPair> pairs, double otherwise);

}  // namespace tessera
