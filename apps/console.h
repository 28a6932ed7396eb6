// Output on stderr during a run: a progress bar if stderr is a terminal, and always the warnings.
#pragma once

#include <cstdint>
#include <string>

#include "core/stopwatch.h"
#include "run/run.h"

namespace tessera {

class Console {
  public:
    Console();
    ~Console() { ClearBar(); }
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    void Info(const std::string& text);
    void Warning(const std::string& text);
    // Draws at most ten times a second.
    void ShowProgress(const RunCounts& counts, std::int64_t total);

    // Prints the source's notes and the run's warnings, and draws the bar. The Console must outlive
    // the observer.
    RunObserver Observer();

  private:
    void ClearBar();

    bool is_terminal_;
    bool bar_shown_ = false;
    Stopwatch watch_;
    double since_bar_ms_ = 0, elapsed_ms_ = 0;
};

}  // namespace tessera
