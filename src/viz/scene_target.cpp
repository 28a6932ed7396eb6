#include "viz/scene_target.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace tessera {

SceneTarget::SceneTarget() {
    glGenFramebuffers(1, &framebuffer_);
    glGenFramebuffers(1, &smooth_framebuffer_);
    glGenTextures(1, &colour_);
    glGenTextures(1, &depth_);
    glGenRenderbuffers(2, smooth_);
}

SceneTarget::~SceneTarget() {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteFramebuffers(1, &smooth_framebuffer_);
    glDeleteTextures(1, &colour_);
    glDeleteTextures(1, &depth_);
    glDeleteRenderbuffers(2, smooth_);
}

void SceneTarget::Resize(int width, int height, int samples) {
    const auto set = [&](GLuint texture, GLint format, GLenum channels, GLenum type,
                         GLenum attachment) {
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, channels, type, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
    };
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    set(colour_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT0);
    set(depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_DEPTH_ATTACHMENT);
    if (samples > 1) {
        glBindFramebuffer(GL_FRAMEBUFFER, smooth_framebuffer_);
        const auto attach = [&](int i, GLenum format, GLenum attachment) {
            glBindRenderbuffer(GL_RENDERBUFFER, smooth_[i]);
            glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
            glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, smooth_[i]);
        };
        attach(0, GL_RGBA8, GL_COLOR_ATTACHMENT0);
        attach(1, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
    }
    width_ = width;
    height_ = height;
    samples_ = samples;
}

void SceneTarget::Begin(int width, int height, int samples) {
    GLint most = 1;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    samples = std::clamp(samples, 1, std::max(most, 1));
    if (width != width_ || height != height_ || samples != samples_) Resize(width, height, samples);
    glBindFramebuffer(GL_FRAMEBUFFER, samples > 1 ? smooth_framebuffer_ : framebuffer_);
    glViewport(0, 0, width, height);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void SceneTarget::End() {
    if (samples_ > 1) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, smooth_framebuffer_);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
        glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_,
                          GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

float SceneTarget::DepthAt(int x, int y) const {
    float depth = 1;
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return depth;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glReadPixels(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return depth;
}

}  // namespace tessera
