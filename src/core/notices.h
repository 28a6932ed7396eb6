// Messages for the user from all threads, in one bounded queue.
#pragma once

#include <optional>
#include <string>

#include "core/queue.h"

namespace tessera {

// Appends a message, unless it is empty, to others for the same line.
inline void AddNote(const std::string& note, std::string& notes) {
    if (!note.empty()) notes += (notes.empty() ? "" : "; ") + note;
}

// Any thread may tell and take. If nobody takes for long, the oldest messages are dropped.
class Notices {
  public:
    // `reader` is notified of every message and outlives the object.
    explicit Notices(Wake& reader) : messages_(kCapacity, reader) {}

    // Does nothing if the text is empty.
    void Tell(std::string text) {
        if (!text.empty()) messages_.Push(std::move(text));
    }
    std::optional<std::string> Take() {
        std::string text;
        if (!messages_.TryPop(text)) return std::nullopt;
        return text;
    }

  private:
    static constexpr std::size_t kCapacity = 256;
    NewestQueue<std::string> messages_;
};

}  // namespace tessera
