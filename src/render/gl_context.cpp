#include "render/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <vector>

namespace tessera {
namespace {

constexpr const char* kInstall = "install libegl1, libgl1 and libgl1-mesa-dri";

// epoxy aborts the program if a library that it needs is missing.
bool HasLibraries() {
    const auto loads = [](const char* name) {
        void* handle = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
        if (handle) dlclose(handle);
        return handle != nullptr;
    };
    return epoxy_has_egl() && (loads("libOpenGL.so.0") || loads("libGL.so.1"));
}

bool HasClientExtension(const char* name) { return epoxy_has_egl_extension(EGL_NO_DISPLAY, name); }

// Mesa without a display server comes first, because it prints nothing and needs nothing. Then come
// the devices, through which NVIDIA's driver is found.
std::vector<EGLDisplay> WindowlessDisplays() {
    std::vector<EGLDisplay> displays;
    if (!HasClientExtension("EGL_EXT_platform_base")) return displays;
    if (HasClientExtension("EGL_MESA_platform_surfaceless"))
        displays.push_back(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    if (HasClientExtension("EGL_EXT_platform_device") &&
        HasClientExtension("EGL_EXT_device_enumeration")) {
        std::array<EGLDeviceEXT, 16> devices;
        EGLint count = 0;
        if (!eglQueryDevicesEXT(devices.size(), devices.data(), &count)) count = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            displays.push_back(
                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
    return displays;
}

}  // namespace

Result<std::unique_ptr<GlContext>> GlContext::Create() {
    if (!HasLibraries())
        return Status::Error(fmt::format("EGL and OpenGL libraries not found: {}", kInstall));
    std::unique_ptr<GlContext> found;
    std::string why;  // error of the first display, the likeliest one
    const auto try_display = [&](EGLDisplay display) {
        std::unique_ptr<GlContext> context(new GlContext(display));
        const Status status = context->Initialise();
        if (!status.ok() && why.empty()) why = status.message();
        if (status.ok() && (!found || found->is_software_)) found = std::move(context);
    };
    for (const EGLDisplay display : WindowlessDisplays())
        if (!found || found->is_software_) try_display(display);
    if (!found) try_display(eglGetDisplay(EGL_DEFAULT_DISPLAY));
    if (found) return found;
    return Status::Error(fmt::format(
        "cannot create an OpenGL 3.3 context without a window ({}): {}", why, kInstall));
}

Status GlContext::Initialise() {
    if (display_ == EGL_NO_DISPLAY) return Status::Error("EGL found no driver");
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display_, &major, &minor)) return Status::Error("EGL failed to initialise");
    if (!epoxy_has_egl_extension(display_, "EGL_KHR_surfaceless_context") ||
        !epoxy_has_egl_extension(display_, "EGL_KHR_create_context"))
        return Status::Error("EGL does not support contexts without a surface");
    const EGLenum api_before = eglQueryAPI();
    if (!eglBindAPI(EGL_OPENGL_API)) return Status::Error("EGL does not support desktop OpenGL");
    const EGLint config_wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                    EGL_NONE};
    const EGLint context_wanted[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION_KHR,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                     EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (eglChooseConfig(display_, config_wanted, &config, 1, &configs) && configs == 1)
        context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, context_wanted);
    eglBindAPI(api_before);
    if (!context_) return Status::Error("the driver does not support an OpenGL 3.3 core context");

    const Scope scope(*this);
    const int version = epoxy_gl_version();
    const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    renderer_ =
        fmt::format("{}, OpenGL {}.{}", name ? name : "unnamed", version / 10, version % 10);
    is_software_ = renderer_.find("llvmpipe") != std::string::npos ||
                   renderer_.find("softpipe") != std::string::npos ||
                   renderer_.find("swrast") != std::string::npos;
    return version >= 33 ? Status::Ok() : Status::Error(fmt::format("{} is too old", renderer_));
}

// The display is not terminated: it belongs to the process, EGL does not count its users, and a
// window may use it.
GlContext::~GlContext() {
    if (context_) eglDestroyContext(display_, context_);
}

GlContext::Scope::Scope(const GlContext& context)
    : api_before_(eglQueryAPI()), display_(context.display_) {
    eglBindAPI(EGL_OPENGL_API);
    display_before_ = eglGetCurrentDisplay();
    context_before_ = eglGetCurrentContext();
    draw_before_ = eglGetCurrentSurface(EGL_DRAW);
    read_before_ = eglGetCurrentSurface(EGL_READ);
    const bool done = eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_);
    TESSERA_CHECK(done, "EGL error {:#x}: is the context in use on another thread?", eglGetError());
}

GlContext::Scope::~Scope() {
    if (context_before_)
        eglMakeCurrent(display_before_, draw_before_, read_before_, context_before_);
    else
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglBindAPI(api_before_);
}

}  // namespace tessera
