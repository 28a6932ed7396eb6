// The edge where a Status becomes a Python exception: pybind11 turns std::invalid_argument into
// ValueError and std::runtime_error into RuntimeError. Only the module throws; the libraries below
// it never do.
#pragma once

#include <stdexcept>
#include <utility>

#include "core/status.h"

namespace tessera::python {

// What the caller gave is wrong.
inline void ThrowIfBadInput(const Status& status) {
    if (!status.ok()) throw std::invalid_argument(status.message());
}

// What was right at first broke later: a source, a full disk.
inline void ThrowIfBroken(const Status& status) {
    if (!status.ok()) throw std::runtime_error(status.message());
}

template <class T>
T ValueOrBadInput(Result<T> result) {
    ThrowIfBadInput(result.status());
    return std::move(result.value());
}

}  // namespace tessera::python
