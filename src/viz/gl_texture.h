// An image in GPU memory, for ImGui. Made, used and destroyed with the OpenGL context current.
#pragma once

#include "core/image.h"

namespace tessera {

class GlTexture {
  public:
    GlTexture() = default;
    ~GlTexture();
    GlTexture(const GlTexture&) = delete;
    GlTexture& operator=(const GlTexture&) = delete;

    void Set(const ColourImage& image);
    void Clear() { width_ = height_ = 0; }

    unsigned name() const { return name_; }
    bool empty() const { return width_ == 0; }
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    unsigned name_ = 0;
    int width_ = 0, height_ = 0;
};

}  // namespace tessera
