// An X server without a screen (Xvfb) for one test, and control of its pointer and keyboard through
// real input events from XTest.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

struct _XDisplay;

namespace tessera::testing_support {

class VirtualDisplay {
  public:
    // Starts the server and sets DISPLAY. Returns null, with the reason in `why`, if Xvfb is
    // missing or does not start. `size`: of the screen, in pixels.
    static std::unique_ptr<VirtualDisplay> Start(std::string& why,
                                                 const std::string& size = "1280x800");
    ~VirtualDisplay();

    // Screen pixels. Without a window manager the window begins at (0, 0). On return the server has
    // moved the pointer and sent the events.
    void MoveTo(float x, float y);
    void Press(int button);  // 1 left, 2 middle, 3 right, 4 wheel up, 5 wheel down
    void Release(int button);
    void PressKey(unsigned long keysym);
    void ReleaseKey(unsigned long keysym);
    bool HasWindow(const std::string& title) const { return FindWindow(title) != 0; }
    // Acts like the close button of a window manager, on the first window with this title.
    bool AskToClose(const std::string& title);
    // Ends the server at once. Afterwards only the destructor may be called.
    void Kill();

  private:
    VirtualDisplay() = default;
    unsigned long FindWindow(const std::string& title) const;  // the first; 0: none

    pid_t server_ = -1;
    _XDisplay* connection_ = nullptr;
};

}  // namespace tessera::testing_support
