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
    for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        sigaction(signal_number, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(signal_number, &action, nullptr);
    }
    // Whoever reads the messages may be gone; the run goes on.
    std::signal(SIGPIPE, SIG_IGN);
    return stop_requested;
}

}  // namespace tessera
