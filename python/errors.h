// Turns a Status into a Python exception: pybind11 converts std::invalid_argument to ValueError and
// std::runtime_error to RuntimeError. Only the module throws; the libraries never do.
#pragma once

#include <stdexcept>
#include <utility>

#include "core/status.h"

namespace tessera::python {

// For errors in the caller's arguments.
inline void ThrowIfBadInput(const Status& status) {
    if (!status.ok()) throw std::invalid_argument(status.message());
}

// For errors that occur later: a source that fails, a full disk.
inline void ThrowIfBroken(const Status& status) {
    if (!status.ok()) throw std::runtime_error(status.message());
}

template <class T>
T ValueOrBadInput(Result<T> result) {
    ThrowIfBadInput(result.status());
    return std::move(result.value());
}

}  // namespace tessera::python
