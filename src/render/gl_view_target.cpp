#include "render/gl_view_target.h"

#include <epoxy/gl.h>
#include <tbb/parallel_for.h>

#include "render/projection.h"

namespace tessera {

GlViewTarget::GlViewTarget(bool labels) : labels_(labels) {
    glGenFramebuffers(1, &framebuffer_);
    glGenRenderbuffers(kAttachments, images_);
}

GlViewTarget::~GlViewTarget() {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(kAttachments, images_);
}

Status GlViewTarget::Begin(int width, int height) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (width != width_ || height != height_)
        if (const Status status = Resize(width, height); !status.ok()) return status;
    glViewport(0, 0, width, height);
    constexpr GLfloat kNothing[4] = {}, kFar = 1;
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_COLOR, kSurface, kNothing);
    glClearBufferfv(GL_COLOR, kColour, kNothing);
    glClearBufferfv(GL_DEPTH, 0, &kFar);
    constexpr GLuint kNoLabel[4] = {};
    if (labels_) glClearBufferuiv(GL_COLOR, kLabel, kNoLabel);
    return Status::Ok();
}

Status GlViewTarget::Resize(int width, int height) {
    width_ = height_ = 0;
    GLint most = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    if (width < 1 || height < 1 || width > most || height > most)
        return Status::Error(
            fmt::format("cannot draw a view of {} x {} pixels: each side must be 1 to {}", width,
                        height, most));
    while (glGetError() != GL_NO_ERROR) {
    }
    const auto attach = [&](Attachment image, GLenum format, GLenum attachment) {
        glBindRenderbuffer(GL_RENDERBUFFER, images_[image]);
        glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, images_[image]);
    };
    attach(kSurface, GL_RGBA32F, GL_COLOR_ATTACHMENT0);
    attach(kColour, GL_RGBA8, GL_COLOR_ATTACHMENT1);
    if (labels_) attach(kLabel, GL_R16UI, GL_COLOR_ATTACHMENT2);
    attach(kDepth, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    constexpr GLenum kOutputs[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                   GL_COLOR_ATTACHMENT2};
    glDrawBuffers(labels_ ? 3 : 2, kOutputs);
    if (glGetError() != GL_NO_ERROR ||
        glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return Status::Error(fmt::format(
            "the OpenGL driver cannot allocate a view of {} x {} pixels", width, height));
    width_ = width;
    height_ = height;
    return Status::Ok();
}

void GlViewTarget::ReadBack(float near_m, float far_m, PredictedView& view) {
    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    surface_.resize(4 * pixels);
    colour_.resize(4 * pixels);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, surface_.data());
    glReadBuffer(GL_COLOR_ATTACHMENT1);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, colour_.data());
    glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, view.depth_m.data());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, 1 << 14), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            float& depth = view.depth_m.data()[i];
            const bool seen = depth < 1;
            const float *surface = &surface_[4 * i], mask = seen ? 1.0f : 0.0f;
            const std::uint8_t* colour = &colour_[4 * i];
            depth =
                seen
                    ? static_cast<float>(DepthFromBuffer(static_cast<double>(depth), near_m, far_m))
                    : 0;
            view.normal_camera.data()[i] =
                mask * Eigen::Vector3f(surface[0], surface[1], surface[2]);
            view.intensity.data()[i] = mask * surface[3];
            view.colour.data()[i] = seen ? Rgb8{colour[0], colour[1], colour[2]} : Rgb8{};
        }
    });
}

void GlViewTarget::ReadLabels(Image<std::uint16_t>& labels) {
    labels.Resize(width_, height_);
    glReadBuffer(GL_COLOR_ATTACHMENT2);
    glPixelStorei(GL_PACK_ALIGNMENT, sizeof(std::uint16_t));
    glReadPixels(0, 0, width_, height_, GL_RED_INTEGER, GL_UNSIGNED_SHORT, labels.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
}

}  // namespace tessera
