// Which colour image belongs to which depth image, while both still come: what stamp_pairing.h does
// for whole lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "core/image.h"

namespace tessera {

// Each image is used once; a depth image is paired with the colour image nearest in time, less than
// max_gap_s away, as soon as none nearer can come: at once if they are nearer than half a period.
// (Nearest as stamp_pairing.h has it, but for images halfway between two partners, where a whole
// list may decide otherwise.) What finds no partner is left out and counted. Images are swapped in
// and out, so that their storage goes round. Owner thread only.
class StreamPairing {
  public:
    struct Pair {
        double depth_stamp_s = 0, colour_stamp_s = 0;
        Image<std::uint16_t> depth;
        ColourImage colour;
    };

    // period_s: the shorter one of the two streams' times between images.
    StreamPairing(double max_gap_s, double period_s) : max_gap_s_(max_gap_s), period_s_(period_s) {}

    // Stamps of one stream must increase. `image` becomes an unspecified image.
    void AddDepth(double stamp_s, Image<std::uint16_t>& image);
    void AddColour(double stamp_s, ColourImage& image);
    // Nothing more will come: what waits for a nearer partner takes the one that there is.
    void End() { ended_ = true; }
    // Forgets the waiting images (uncounted).
    void Clear();

    // The next pair in order of time, if there is one that is settled.
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
        void Drop();  // the first
        std::deque<Item> items;
        std::deque<Pixels> spare;
    };

    // The colour image for the first depth image: its index, kNone, or kUndecided.
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
