// Extensions of the host device to device_backend.h: it accepts any function as a command.
#pragma once

#include <functional>

#include "cuda/device_backend.h"

namespace tessera::TESSERA_DEVICE::backend {

// Runs the command when the stream is waited for, after all earlier commands.
void Enqueue(void* stream, std::function<void()> command);

// Calls piece(0) to piece(count - 1) once each, on several threads, the last ones first.
void InAnyOrder(int count, const std::function<void(int)>& piece);

}  // namespace tessera::TESSERA_DEVICE::backend
