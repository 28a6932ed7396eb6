// What the host device does beyond device_backend.h: it takes commands that are any function.
#pragma once

#include <functional>

#include "cuda/device_backend.h"

namespace tessera::TESSERA_DEVICE::backend {

// Done when the stream is waited for, after what it was given before.
void Enqueue(void* stream, std::function<void()> command);

// Calls piece(0) to piece(count - 1), each once: in several threads, the last ones first.
void InAnyOrder(int count, const std::function<void(int)>& piece);

}  // namespace tessera::TESSERA_DEVICE::backend
