// The picture of the 3D view, drawn apart from the window so that it can be shown again without
// being drawn again, and asked for depths. Made, used and destroyed with the OpenGL context
// current.
#pragma once

namespace tessera {

class SceneTarget {
  public:
    SceneTarget();
    ~SceneTarget();
    SceneTarget(const SceneTarget&) = delete;
    SceneTarget& operator=(const SceneTarget&) = delete;

    // All that is drawn goes there, onto transparent black; `samples` per pixel, 1 or more, as far
    // as the driver goes.
    void Begin(int width, int height, int samples);
    // The picture is complete.
    void End();

    unsigned texture() const { return colour_; }  // row 0 at the top
    int width() const { return width_; }
    int height() const { return height_; }
    // Of the depth buffer, in [0, 1]; 1 where nothing was drawn, and outside.
    float DepthAt(int x, int y) const;

  private:
    void Resize(int width, int height, int samples);

    unsigned framebuffer_ = 0, smooth_framebuffer_ = 0;
    unsigned colour_ = 0, depth_ = 0;  // textures of the former
    unsigned smooth_[2] = {};          // renderbuffers of the latter
    int width_ = 0, height_ = 0, samples_ = 0;
};

}  // namespace tessera
