// What the start screen finds out on threads of its own: what a path is, and which cameras there
// are.
#pragma once

#include <optional>
#include <string>

#include "core/worker.h"
#include "viz/start_screen.h"

namespace tessera {

// Owner thread only.
class StartLookup {
  public:
    // `services` outlives the lookup.
    explicit StartLookup(const StartServices& services);

    // Takes what the threads have found. True if there was anything.
    bool Update();

    // Asks what the path is, unless that is known or being found out already.
    void Examine(const std::string& path);
    // What the path is; null unless it is the last one examined, and the answer is there.
    const PathFinding* FindingOf(const std::string& path) const;

    void ListCameras();
    bool cameras_asked() const { return cameras_asked_; }
    const std::optional<OpenniListing>& cameras() const { return cameras_; }  // empty: being listed

  private:
    struct Examined {
        std::string path;
        PathFinding finding;
    };

    Examined examined_;
    std::string asked_;  // the path that is examined, or was last
    std::optional<OpenniListing> cameras_;
    bool cameras_asked_ = false;
    Wake taken_;
    NewestQueue<Examined> findings_{1, taken_};
    NewestQueue<OpenniListing> listings_{1, taken_};
    Worker<std::string, NewestQueue> examiner_;
    Worker<char, NewestQueue> lister_;
};

}  // namespace tessera
