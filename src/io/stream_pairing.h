// Pairs colour and depth images while they arrive, as stamp_pairing.h does for complete lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "core/image.h"

namespace tessera {

// Pairs a depth image with the colour image nearest in time, if that is less than max_gap_s away.
// Each image is used once. A pair is settled as soon as no nearer image can arrive: at once if the
// two are less than half a period apart. (The result is that of stamp_pairing.h, except for images
// halfway between two partners, where the complete list may decide differently.) Images without a
// partner are dropped and counted. Images are swapped in and out, so their storage is recycled.
// Owner thread only.
class StreamPairing {
  public:
    struct Pair {
        double depth_stamp_s = 0, colour_stamp_s = 0;
        Image<std::uint16_t> depth;
        ColourImage colour;
    };

    // period_s is the shorter of the two streams' frame periods.
    StreamPairing(double max_gap_s, double period_s) : max_gap_s_(max_gap_s), period_s_(period_s) {}

    // Stamps of one stream must increase. `image` is unspecified afterwards.
    void AddDepth(double stamp_s, Image<std::uint16_t>& image);
    void AddColour(double stamp_s, ColourImage& image);
    // No more images will arrive. Images that wait for a nearer partner take the one available.
    void End() { ended_ = true; }
    // Drops the waiting images without counting them.
    void Clear();

    // Returns the next settled pair in time order, if there is one.
    bool Next(Pair& pair);

    std::int64_t pairs() const { return pairs_; }
    std::int64_t depth_alone() const { return depth_alone_; }
    std::int64_t colour_alone() const { return colour_alone_; }

  private:
    template <class Pixels>
    struct Stream {
        struct Item {
            double stamp_s;
            Pixels image;
        };
        void Add(double stamp_s, Pixels& image);
        void Drop();  // drops the first item
        std::deque<Item> items;
        std::deque<Pixels> spare;
    };

    // The partner of the first depth image: index of the colour image, kNone, or kUndecided.
    static constexpr std::ptrdiff_t kNone = -1, kUndecided = -2;
    std::ptrdiff_t Partner() const;
    double Gap(std::size_t depth, std::size_t colour) const;

    double max_gap_s_, period_s_;
    Stream<Image<std::uint16_t>> depth_;
    Stream<ColourImage> colour_;
    std::int64_t pairs_ = 0, depth_alone_ = 0, colour_alone_ = 0;
    bool ended_ = false;
};

}  // namespace tessera
