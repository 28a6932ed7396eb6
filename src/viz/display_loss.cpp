#include "viz/display_loss.h"

#include <dlfcn.h>

#include <atomic>

namespace tessera {
namespace {

// Global, because X11's handlers apply to the whole process.
std::atomic<bool> lost{false};

void OnConnectionLost(void*, void*) { lost = true; }

// Replaces the default handler, which prints an error and ends the process.
int OnIoError(void*) { return 0; }

// Ignores failed requests (for example on a window that another program closed); they do no harm.
int OnError(void*, void*) { return 0; }

template <class Function>
Function Find(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

// Looks the functions up by name, because GLFW may be built without X11.
void HandleDisplayLoss() {
    lost = false;
    const auto get_display = Find<void* (*)()>("glfwGetX11Display");
    void* display = get_display ? get_display() : nullptr;
    if (!display) return;
    if (const auto set =
            Find<void (*)(void*, void (*)(void*, void*), void*)>("XSetIOErrorExitHandler"))
        set(display, OnConnectionLost, nullptr);
    if (const auto set = Find<void* (*)(int (*)(void*))>("XSetIOErrorHandler")) set(OnIoError);
    if (const auto set = Find<void* (*)(int (*)(void*, void*))>("XSetErrorHandler")) set(OnError);
}

bool DisplayIsLost() { return lost; }

}  // namespace tessera
