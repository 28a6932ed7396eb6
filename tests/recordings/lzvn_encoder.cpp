#include "recordings/lzvn_encoder.h"

namespace tessera {
namespace {

class LzvnWriter {
  public:
    explicit LzvnWriter(std::span<const std::uint8_t> literals) : literals_(literals) {
        Put(0x0e);  // Both of these do nothing.
        Put(0x16);
    }

    void Step(LzStep step) {
        while (step.literals > 3 || (step.literals > 0 && step.match == 0))
            step.literals -= LiteralsOnly(step.literals);
        if (step.match > 0 && (step.literals > 0 || step.distance != distance_)) Pair(step);
        while (step.match > 0) step.match -= MatchOnly(step.match);
    }

    std::vector<std::uint8_t> End() {
        for (int i = 0; i < 8; ++i) Put(i == 0 ? 6 : 0);
        return std::move(bytes_);
    }

  private:
    void Put(std::size_t byte) { bytes_.push_back(static_cast<std::uint8_t>(byte)); }
    void PutLiterals(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) Put(literals_[i]);
        literals_ = literals_.subspan(count);
    }

    std::size_t LiteralsOnly(std::size_t count) {
        count = std::min<std::size_t>(count, 271);
        if (count < 16) {
            Put(0xe0 + count);
        } else {
            Put(0xe0);
            Put(count - 16);
        }
        PutLiterals(count);
        return count;
    }

    std::size_t MatchOnly(std::size_t count) {
        count = std::min<std::size_t>(count, 271);
        if (count < 16) {
            Put(0xf0 + count);
        } else {
            Put(0xf0);
            Put(count - 16);
        }
        return count;
    }

    // Literals and the first part of the match.
    void Pair(LzStep& step) {
        const std::size_t l = step.literals, d = step.distance;
        // Longer ones would be other opcodes.
        std::size_t m = std::min(step.match, 10 - 2 * l);
        if (d == distance_ && l > 0) {
            Put(l << 6 | (m - 3) << 3 | 6);
        } else if (d < 0x600) {
            Put(l << 6 | (m - 3) << 3 | d >> 8);
            Put(d & 255);
        } else if (d < 0x4000) {
            m = std::min<std::size_t>(step.match, 34);
            Put(0xa0 | l << 3 | (m - 3) >> 2);
            Put((d & 63) << 2 | ((m - 3) & 3));
            Put(d >> 6);
        } else {
            Put(l << 6 | (m - 3) << 3 | 7);
            Put(d & 255);
            Put(d >> 8);
        }
        PutLiterals(l);
        distance_ = d;
        step.match -= m;
    }

    std::span<const std::uint8_t> literals_;
    std::vector<std::uint8_t> bytes_;
    std::size_t distance_ = 0;
};

}  // namespace

std::vector<std::uint8_t> EncodeLzvn(std::span<const LzStep> steps,
                                     std::span<const std::uint8_t> literals) {
    LzvnWriter writer(literals);
    for (const LzStep& step : steps) writer.Step(step);
    return writer.End();
}

}  // namespace tessera
