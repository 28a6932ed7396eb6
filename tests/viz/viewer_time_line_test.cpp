// Scrubs through a finished run with the mouse and the keyboard.
#include <X11/keysym.h>

#include "viz/model_window.h"

namespace tessera {
namespace {

// Ten frames, 0.1 s apart, along x in front of a square. Frame 4 was lost.
ViewedModel MadeUpModel() {
    ViewedModel model;
    model.mesh.vertices = {{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}};
    model.mesh.colours.assign(4, Rgb8{90, 90, 90});
    model.mesh.triangles = {{0, 3, 1}, {1, 3, 2}};
    TimeLine line;
    line.has_figures = true;
    for (int i = 0; i < 10; ++i) {
        TimeLineFrame& frame = line.frames.emplace_back();
        frame.row.index = 100 + i;
        frame.row.state = i == 4 ? FrameState::kLost : FrameState::kFused;
        frame.at_s = 0.1 * i;
        if (i == 4) continue;
        frame.T_world_camera = Eigen::Isometry3d::Identity();
        frame.T_world_camera->translation() = Eigen::Vector3d(-0.9 + 0.2 * i, 0, 1.5);
        model.path.push_back(*frame.T_world_camera);
    }
    model.time_line = std::move(line);
    return model;
}

class RedSource : public FrameSource {
  public:
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        frame.index = next_;
        frame.colour = ColourImage(64, 48);
        for (std::size_t i = 0; i < frame.colour.size(); ++i)
            frame.colour.data()[i] = {250, 20, 20};
        return {};
    }
    bool Seek(std::int64_t index) override {
        next_ = index;
        return true;
    }

  private:
    SourceInfo info_;
    std::int64_t next_ = 0;
};

class ViewerTimeLine : public testing_support::ModelWindow {
  protected:
    // The number of the shown frame; -1: none.
    int Frame() const {
        for (int i = 100; i < 110; ++i)
            if (FindControl("time_line.frame." + std::to_string(i))) return i;
        return -1;
    }
    float CameraX() const { return Find("time_line.camera").x; }
    // Pixels of the 3D view.
    int Count(bool (*is)(const Rgb8&)) {
        const ColourImage picture = viewer_->Picture();
        const int height = std::min(static_cast<int>(Find("view").height), picture.height());
        int count = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < picture.width(); ++x) count += is(picture(x, y));
        return count;
    }
};

TEST_F(ViewerTimeLine, TheSliderMovesTheCamera) {
    Open(MadeUpModel());
    EXPECT_EQ(Frame(), 100);
    const float first = CameraX();
    Click("time_line", 0.5f);
    EXPECT_NEAR(Frame(), 104.5, 1);
    const float middle = CameraX();
    display_->Press(1);
    MoveTo("time_line", 0.99f);  // a drag
    EXPECT_EQ(Frame(), 109);
    display_->Release(1);
    Rounds(3);
    const float last = CameraX();
    EXPECT_GT(std::abs(middle - first), 20);
    EXPECT_GT((last - middle) * (middle - first), 0);  // in one direction
    const ControlRect view = Find("view"), bar = Find("time_line");
    EXPECT_GE(bar.y, view.y + view.height);  // below the mesh, not over it
}

TEST_F(ViewerTimeLine, KeysStepAndJump) {
    Open(MadeUpModel());
    Key(XK_Right);
    Key(XK_Right);
    EXPECT_EQ(Frame(), 102);
    Key(XK_Left);
    EXPECT_EQ(Frame(), 101);
    Key(XK_End);
    EXPECT_EQ(Frame(), 109);
    Key(XK_Right);
    EXPECT_EQ(Frame(), 109);
    Key(XK_Home);
    EXPECT_EQ(Frame(), 100);
    Key(XK_Left);
    EXPECT_EQ(Frame(), 100);
}

TEST_F(ViewerTimeLine, PlaysToTheEndAndPauses) {
    Open(MadeUpModel());
    Click("time_line.play");
    EXPECT_TRUE(Within(20, [&] { return Frame() > 101; }));
    Key(XK_space);
    const int paused = Frame();
    Rounds(50);
    EXPECT_EQ(Frame(), paused);
    Key(XK_space);
    EXPECT_TRUE(Within(20, [&] { return Frame() == 109; }));
}

bool IsRed(const Rgb8& c) { return c.r > 200 && c.g < 110 && c.b < 110; }
bool IsPath(const Rgb8& c) { return c.b > 200 && c.r < 110; }

// The pyramid is red where the camera was lost, and the path is bright only as far as it has come.
TEST_F(ViewerTimeLine, TheCameraAndThePathShowTheFrame) {
    Open(MadeUpModel());
    display_->MoveTo(5, 400);
    Rounds(3);
    const int red_at_first = Count(IsRed), path_at_first = Count(IsPath);
    for (int i = 0; i < 4; ++i) Key(XK_Right);
    EXPECT_EQ(Frame(), 104);
    EXPECT_GT(Count(IsRed), red_at_first + 50);
    const int path_in_between = Count(IsPath);
    Key(XK_End);
    EXPECT_GT(path_in_between, path_at_first + 30);
    EXPECT_GT(Count(IsPath), path_in_between + 30);
}

// Under the slider, at its right end, where nothing else is red.
TEST_F(ViewerTimeLine, TheLastFrameIsMarked) {
    for (const bool lost : {false, true}) {
        ViewedModel model = MadeUpModel();
        if (lost) model.time_line->frames.back().row.state = FrameState::kLost;
        Open(std::move(model));
        const ColourImage picture = viewer_->Picture();
        const ControlRect slider = Find("time_line");
        const int right = static_cast<int>(slider.x + slider.width);
        int red = 0;
        for (int y = static_cast<int>(slider.y); y < static_cast<int>(slider.y + slider.height);
             ++y)
            for (int x = right - 14; x < right; ++x) red += IsRed(picture(x, y));
        EXPECT_EQ(red > 0, lost);
        viewer_.reset();
    }
}

TEST_F(ViewerTimeLine, TheFramesImageIsShownWhereThereIsOne) {
    ViewedModel model = MadeUpModel();
    model.open_source = []() -> Result<std::unique_ptr<FrameSource>> {
        return std::unique_ptr<FrameSource>(std::make_unique<RedSource>());
    };
    Open(std::move(model));
    EXPECT_TRUE(Within(20, [&] { return FindControl("camera_image").has_value(); }));
    EXPECT_GT(Count(IsRed), 1000);
    MoveTo("view");
    Key(XK_i);
    EXPECT_FALSE(FindControl("camera_image"));
}

TEST_F(ViewerTimeLine, ASourceThatIsGoneIsNoMatter) {
    ViewedModel model = MadeUpModel();
    model.open_source = []() -> Result<std::unique_ptr<FrameSource>> {
        return Status::Error("gone");
    };
    Open(std::move(model));
    Key(XK_Right);
    Rounds(100);
    EXPECT_FALSE(FindControl("camera_image"));
    EXPECT_EQ(Frame(), 101);
}

TEST_F(ViewerTimeLine, AMeshAloneHasNone) {
    ViewedModel model = MadeUpModel();
    model.time_line.reset();
    Open(std::move(model));
    EXPECT_FALSE(FindControl("time_line"));
    EXPECT_FALSE(FindControl("time_line.play"));
    Key(XK_Right);  // does nothing
    EXPECT_FALSE(FindControl("follow"));
}

TEST_F(ViewerTimeLine, TheViewFollowsTheCamera) {
    Open(MadeUpModel());
    const float before = CameraX();
    Key(XK_End);
    EXPECT_GT(std::abs(CameraX() - before), 20);
    Click("follow");
    const ControlRect view = Find("view");
    EXPECT_TRUE(Within(
        20, [&] { return std::abs(CameraX() - (view.x + view.width / 2)) < 0.1f * view.width; }));
}

}  // namespace
}  // namespace tessera
