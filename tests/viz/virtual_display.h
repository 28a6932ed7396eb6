// An X server without a screen (Xvfb) of the test's own, and a hand on its pointer and keyboard:
// real input events, as XTest makes them.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

struct _XDisplay;

namespace tessera::testing_support {

class VirtualDisplay {
  public:
    // Sets DISPLAY. Null where there is no Xvfb or it does not start; `why` then says so.
    static std::unique_ptr<VirtualDisplay> Start(std::string& why);
    ~VirtualDisplay();

    // Pixels of the screen, where a window without a window manager begins at (0, 0). On return the
    // server has done it and sent the events.
    void MoveTo(float x, float y);
    void Press(int button);  // 1 left, 2 middle, 3 right, 4 wheel up, 5 wheel down
    void Release(int button);
    void PressKey(unsigned long keysym);
    void ReleaseKey(unsigned long keysym);
    // As a window manager does when its close button is pressed; of the first window with this
    // title.
    bool AskToClose(const std::string& title);
    // The server ends at once; nothing but the destructor may be called afterwards.
    void Kill();

  private:
    VirtualDisplay() = default;

    pid_t server_ = -1;
    _XDisplay* connection_ = nullptr;
};

}  // namespace tessera::testing_support
