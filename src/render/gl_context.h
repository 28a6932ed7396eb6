// An OpenGL 3.3 core context without a window, through EGL: on a GPU or with Mesa's software
// renderer.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"

namespace tessera {

// For one thread at a time. Objects made in the context must be destroyed before it, while it is
// current.
class GlContext {
  public:
    // Prefers a GPU to software. The error is one line that says what is missing and what to
    // install.
    static Result<std::unique_ptr<GlContext>> Create();
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    // Makes the context current on the calling thread during its lifetime, then restores the
    // previous one. So the context is bound to no thread, and a window's context stays undisturbed.
    class [[nodiscard]] Scope {
      public:
        explicit Scope(const GlContext& context);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

      private:
        unsigned api_before_;
        void *display_, *display_before_, *context_before_, *draw_before_, *read_before_;
    };
    Scope MakeCurrent() const { return Scope(*this); }

    // Renderer and version: "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
    const std::string& renderer() const { return renderer_; }
    bool is_software() const { return is_software_; }

  private:
    explicit GlContext(void* display) : display_(display) {}
    Status Initialise();

    void* display_;
    void* context_ = nullptr;
    std::string renderer_;
    bool is_software_ = false;
};

}  // namespace tessera
