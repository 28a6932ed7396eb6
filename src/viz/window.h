// The operating system's window with its OpenGL 3.3 context and ImGui in it. Knows nothing of what
// is drawn.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/status.h"

struct GLFWwindow;

namespace tessera {

// Main thread only, one at a time in a process. The context is current from Open on.
class Window {
  public:
    struct Key {
        int key = 0;   // GLFW_KEY_*
        int mods = 0;  // GLFW_MOD_*
    };

    // `width` and `height` at usual density; larger on a denser display.
    static Result<std::unique_ptr<Window>> Open(const std::string& title, int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Sleeps until there is input, at most `wait_s`. True if there was any.
    bool WaitForInput(double wait_s);
    bool ShouldClose() const;
    // The keys pressed since the last call, in order.
    std::vector<Key> TakeKeys();

    // Around everything that ImGui draws. Nothing is shown before Show.
    void BeginFrame();
    void EndFrame();
    // Waits until it is drawn.
    void Finish();
    // What EndFrame has drawn.
    ColourImage Read() const;
    void Show();

    float scale() const { return scale_; }  // of text and sizes
    bool is_minimised() const;
    bool is_software() const { return is_software_; }
    const std::string& renderer() const { return renderer_; }

  private:
    Window() = default;
    Status Create(const std::string& title, int width, int height);
    void SetCallbacks();

    GLFWwindow* window_ = nullptr;
    bool has_imgui_ = false, had_input_ = true, is_software_ = false;
    float scale_ = 1;
    std::string renderer_;
    std::vector<Key> keys_;
};

}  // namespace tessera
