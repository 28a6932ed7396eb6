#include "viz/window.h"

#include <epoxy/gl.h>
// After epoxy, which declares the OpenGL functions.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "viz/display_loss.h"
#include "viz/theme.h"

namespace tessera {
namespace {

std::string LastError() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "unknown reason";
}

Window& Self(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

GLFWwindow* CreateWithContext(int api, const std::string& title, int width, int height) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);  // the 3D view has its own
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    return glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
}

}  // namespace

Result<std::unique_ptr<Window>> Window::Open(const std::string& title, int width, int height,
                                             double scale) {
    if (!glfwInit())
        return Status::Error("a window needs a display, and there is none: set DISPLAY");
    std::unique_ptr<Window> window(new Window);
    if (Status status = window->Create(title, width, height, scale); !status.ok()) return status;
    return window;
}

Result<std::shared_ptr<Window>> Window::OpenOrKeep(std::shared_ptr<Window> given,
                                                   const std::string& title, int width, int height,
                                                   double scale) {
    if (given) {
        given->SetTitle(title);
        return given;
    }
    Result<std::unique_ptr<Window>> window = Open(title, width, height, scale);
    if (!window.ok()) return window.status();
    return std::shared_ptr<Window>(std::move(window.value()));
}

Status Window::Create(const std::string& title, int width, int height, double scale) {
    if (scale > 0)
        width = static_cast<int>(width * scale), height = static_cast<int>(height * scale);
    // Tries EGL first, because the predicted views use it.
    for (const int api : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API})
        if (!window_) window_ = CreateWithContext(api, title, width, height);
    if (!window_)
        return Status::Error(
            fmt::format("the display cannot open an OpenGL 3.3 window ({}): install libegl1, "
                        "libgl1 and libgl1-mesa-dri",
                        LastError()));
    HandleDisplayLoss();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(0);  // the viewer controls its own pace; a hidden window must not block it
    const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    renderer_ = name ? name : "unnamed";
    is_software_ = renderer_.find("llvmpipe") != std::string::npos ||
                   renderer_.find("softpipe") != std::string::npos;
    float scale_y = 1;
    glfwGetWindowContentScale(window_, &scale_, &scale_y);
    scale_ = std::clamp(scale > 0 ? static_cast<float>(scale) : scale_, 1.0f, 4.0f);

    SetCallbacks();
    ImGui::CreateContext();
    has_imgui_ = true;
    ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed, so no settings are saved
    ApplyTheme(scale_);
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    return Status::Ok();
}

// ImGui installs its callbacks after these and calls them.
void Window::SetCallbacks() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int mods) {
        Self(window).had_input_ = true;
        const bool arrow = key >= GLFW_KEY_RIGHT && key <= GLFW_KEY_UP;
        if (action == GLFW_PRESS || (action == GLFW_REPEAT && arrow))
            Self(window).keys_.push_back({key, mods});
    });
    glfwSetCursorPosCallback(
        window_, [](GLFWwindow* window, double, double) { Self(window).had_input_ = true; });
    glfwSetCursorEnterCallback(window_,
                               [](GLFWwindow* window, int) { Self(window).had_input_ = true; });
    glfwSetMouseButtonCallback(
        window_, [](GLFWwindow* window, int, int, int) { Self(window).had_input_ = true; });
    glfwSetScrollCallback(
        window_, [](GLFWwindow* window, double, double) { Self(window).had_input_ = true; });
    glfwSetCharCallback(window_,
                        [](GLFWwindow* window, unsigned) { Self(window).had_input_ = true; });
    glfwSetWindowFocusCallback(window_,
                               [](GLFWwindow* window, int) { Self(window).had_input_ = true; });
    glfwSetWindowRefreshCallback(window_,
                                 [](GLFWwindow* window) { Self(window).had_input_ = true; });
    glfwSetFramebufferSizeCallback(
        window_, [](GLFWwindow* window, int, int) { Self(window).had_input_ = true; });
}

Window::~Window() {
    if (has_imgui_) {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    if (window_) glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::WaitForInput(double wait_s) {
    if (wait_s > 0)
        glfwWaitEventsTimeout(wait_s);
    else
        glfwPollEvents();
    return std::exchange(had_input_, false);
}

bool Window::ShouldClose() const { return glfwWindowShouldClose(window_) || DisplayIsLost(); }

void Window::Close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

std::vector<Window::Key> Window::TakeKeys() { return std::exchange(keys_, {}); }

bool Window::is_minimised() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return width < 1 || height < 1 || glfwGetWindowAttrib(window_, GLFW_ICONIFIED);
}

void Window::BeginFrame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::EndFrame() {
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glClearColor(0.07f, 0.075f, 0.085f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

ColourImage Window::Read() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    ColourImage image(width, height), turned(width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glReadBuffer(GL_BACK);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, image.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    for (int y = 0; y < height; ++y) std::copy_n(image.row(height - 1 - y), width, turned.row(y));
    return turned;
}

void Window::SetTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::SetShown(bool shown) {
    if (DisplayIsLost()) return;
    if (shown)
        glfwShowWindow(window_);
    else
        glfwHideWindow(window_);
}

void Window::Finish() { glFinish(); }

void Window::Show() { glfwSwapBuffers(window_); }

}  // namespace tessera
