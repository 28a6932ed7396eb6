#include "optimize/stored_detections.h"

#include <utility>

namespace tessera {

StoredDetections::StoredDetections(std::vector<Detection> detections, const ClassSet& ignored)
    : detections_(std::move(detections)), ignored_(ignored) {
    detections_.shrink_to_fit();
    masks_.reserve(detections_.size());
    for (Detection& d : detections_) {
        const Image<std::uint8_t> mask = std::exchange(d.mask, {});
        Mask& packed = masks_.emplace_back();
        packed.width = mask.width();
        packed.height = mask.height();
        packed.bits.resize((mask.size() + 7) / 8);
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (mask.data()[i] != 0)
                packed.bits[i / 8] = static_cast<std::uint8_t>(packed.bits[i / 8] | 1 << i % 8);
    }
}

std::vector<Detection> StoredDetections::Unpack() const {
    std::vector<Detection> detections = detections_;
    for (std::size_t n = 0; n < detections.size(); ++n) {
        Image<std::uint8_t>& mask = detections[n].mask;
        mask.Resize(masks_[n].width, masks_[n].height);
        for (std::size_t i = 0; i < mask.size(); ++i)
            mask.data()[i] = masks_[n].bits[i / 8] >> i % 8 & 1;
    }
    return detections;
}

std::size_t StoredDetections::memory_bytes() const {
    std::size_t bytes =
        detections_.capacity() * sizeof(Detection) + masks_.capacity() * sizeof(Mask);
    for (const Detection& d : detections_)
        bytes += d.name.size() + d.embedding.capacity() * sizeof(float);
    for (const Mask& mask : masks_) bytes += mask.bits.capacity();
    return bytes;
}

}  // namespace tessera
