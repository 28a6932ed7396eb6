// An operating-system window with an OpenGL 3.3 context and ImGui. Independent of what is drawn.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/status.h"

struct GLFWwindow;

namespace tessera {

// Main thread only, one per process at a time. The context is current once Open returns.
class Window {
  public:
    struct Key {
        int key = 0;   // GLFW_KEY_*
        int mods = 0;  // GLFW_MOD_*
    };

    // `width` and `height` for a standard-density display; scaled up on denser displays.
    // `scale`: of text and sizes; 0: the display's.
    static Result<std::unique_ptr<Window>> Open(const std::string& title, int width, int height,
                                                double scale = 0);
    // `given` with this title, if there is one; else a new window.
    static Result<std::shared_ptr<Window>> OpenOrKeep(std::shared_ptr<Window> given,
                                                      const std::string& title, int width,
                                                      int height, double scale = 0);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Waits for input for at most `wait_s`. True if there was any.
    bool WaitForInput(double wait_s);
    bool ShouldClose() const;
    void Close();  // from now on it should
    void SetTitle(const std::string& title);
    // A window that others go on in is hidden once it is closed, or it would stand there unmoved.
    void SetShown(bool shown);
    // Returns the keys pressed since the last call, in order. An arrow key that is held comes again
    // and again.
    std::vector<Key> TakeKeys();

    // Enclose everything that ImGui draws. Nothing is visible before Show.
    void BeginFrame();
    void EndFrame();
    // Waits until drawing has finished.
    void Finish();
    // Returns what EndFrame has drawn.
    ColourImage Read() const;
    void Show();

    float scale() const { return scale_; }  // of text and sizes
    bool is_minimised() const;
    bool is_software() const { return is_software_; }
    const std::string& renderer() const { return renderer_; }

  private:
    Window() = default;
    Status Create(const std::string& title, int width, int height, double scale);
    void SetCallbacks();

    GLFWwindow* window_ = nullptr;
    bool has_imgui_ = false, had_input_ = true, is_software_ = false;
    float scale_ = 1;
    std::string renderer_;
    std::vector<Key> keys_;
};

}  // namespace tessera
