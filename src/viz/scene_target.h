// Off-screen target of the 3D view. It can be shown again without redrawing, and its depth can be
// read. Made, used and destroyed with the OpenGL context current.
#pragma once

namespace tessera {

class SceneTarget {
  public:
    SceneTarget();
    ~SceneTarget();
    SceneTarget(const SceneTarget&) = delete;
    SceneTarget& operator=(const SceneTarget&) = delete;

    // Redirects drawing to this target and clears it to transparent black. `samples` per pixel, at
    // least 1, limited by the driver.
    void Begin(int width, int height, int samples);
    // Completes the picture.
    void End();

    unsigned texture() const { return colour_; }  // row 0 at the top
    int width() const { return width_; }
    int height() const { return height_; }
    // Depth buffer value in [0, 1]; 1 where nothing was drawn, and outside.
    float DepthAt(int x, int y) const;

  private:
    void Resize(int width, int height, int samples);

    unsigned framebuffer_ = 0, smooth_framebuffer_ = 0;
    unsigned colour_ = 0, depth_ = 0;  // textures of framebuffer_
    unsigned smooth_[2] = {};          // renderbuffers of smooth_framebuffer_
    int width_ = 0, height_ = 0, samples_ = 0;
};

}  // namespace tessera
