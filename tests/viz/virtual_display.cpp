#include "viz/virtual_display.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace tessera::testing_support {
namespace {

// Reads the display number that Xvfb writes when it is ready. Returns nothing if Xvfb exits first.
std::string ReadLine(int pipe_end) {
    std::string line;
    char c = 0;
    while (read(pipe_end, &c, 1) == 1 && c != '\n') line.push_back(c);
    return line;
}

}  // namespace

std::unique_ptr<VirtualDisplay> VirtualDisplay::Start(std::string& why, const std::string& size) {
    int ends[2];
    if (pipe(ends) != 0) return nullptr;
    std::unique_ptr<VirtualDisplay> display(new VirtualDisplay);
    display->server_ = fork();
    if (display->server_ == 0) {
        close(ends[0]);
        (void)!freopen("/dev/null", "w", stderr);
        const std::string fd = std::to_string(ends[1]);
        execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", (size + "x24").c_str(),
               "-nolisten", "tcp", nullptr);
        _exit(127);
    }
    close(ends[1]);
    const std::string number = ReadLine(ends[0]);
    close(ends[0]);
    if (number.empty()) {
        why = "no Xvfb here: install xvfb";
        return nullptr;
    }
    setenv("DISPLAY", (":" + number).c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    display->connection_ = XOpenDisplay(nullptr);
    if (display->connection_) return display;
    why = "Xvfb takes no connection";
    return nullptr;
}

VirtualDisplay::~VirtualDisplay() {
    if (server_ <= 0) return;
    if (connection_) XCloseDisplay(connection_);
    Kill();
}

void VirtualDisplay::Kill() {
    kill(server_, SIGKILL);
    waitpid(server_, nullptr, 0);
    server_ = -1;  // the server is gone, so the connection cannot be closed
    unsetenv("DISPLAY");
}

void VirtualDisplay::MoveTo(float x, float y) {
    XTestFakeMotionEvent(connection_, -1, static_cast<int>(x), static_cast<int>(y), CurrentTime);
    XSync(connection_, False);
}

void VirtualDisplay::Press(int button) {
    XTestFakeButtonEvent(connection_, static_cast<unsigned>(button), True, CurrentTime);
    XSync(connection_, False);
}

void VirtualDisplay::Release(int button) {
    XTestFakeButtonEvent(connection_, static_cast<unsigned>(button), False, CurrentTime);
    XSync(connection_, False);
}

void VirtualDisplay::PressKey(unsigned long keysym) {
    XTestFakeKeyEvent(connection_, XKeysymToKeycode(connection_, keysym), True, CurrentTime);
    XSync(connection_, False);
}

void VirtualDisplay::ReleaseKey(unsigned long keysym) {
    XTestFakeKeyEvent(connection_, XKeysymToKeycode(connection_, keysym), False, CurrentTime);
    XSync(connection_, False);
}

unsigned long VirtualDisplay::FindWindow(const std::string& title) const {
    ::Window root = 0, parent = 0, *windows = nullptr, found = 0;
    unsigned count = 0;
    XQueryTree(connection_, DefaultRootWindow(connection_), &root, &parent, &windows, &count);
    for (unsigned i = 0; i < count && !found; ++i) {
        char* name = nullptr;
        if (XFetchName(connection_, windows[i], &name) && name && title == name) found = windows[i];
        if (name) XFree(name);
    }
    if (windows) XFree(windows);
    return found;
}

bool VirtualDisplay::AskToClose(const std::string& title) {
    const ::Window window = FindWindow(title);
    if (!window) return false;
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = XInternAtom(connection_, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] =
        static_cast<long>(XInternAtom(connection_, "WM_DELETE_WINDOW", False));
    XSendEvent(connection_, window, False, NoEventMask, &event);
    XSync(connection_, False);
    return true;
}

}  // namespace tessera::testing_support
