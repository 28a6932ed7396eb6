#include "core/state_stream.h"

namespace tessera {

void StateWriter::Append(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, data, size);
}

}  // namespace tessera
