#include "stop_signal.h"

#include <csignal>

namespace tessera {
namespace {

// A signal handler can only reach global state.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

const std::atomic<bool>& StopOnSignal() {
    struct sigaction action {};
    action.sa_handler = [](int) { stop_requested.store(true); };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    return stop_requested;
}

}  // namespace tessera
