#include "viz/display_loss.h"

#include <dlfcn.h>

#include <atomic>

namespace tessera {
namespace {

// Of the process, as X11's handlers are.
std::atomic<bool> lost{false};

void OnConnectionLost(void*, void*) { lost = true; }

// In place of the one that says so on the console and ends the process.
int OnIoError(void*) { return 0; }

// A request that failed (a window that another program closed, say) harms nobody.
int OnError(void*, void*) { return 0; }

template <class Function>
Function Find(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

// By name, since GLFW may be one without X11.
void SurviveLossOfDisplay() {
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
