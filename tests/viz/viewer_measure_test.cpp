// Measures, cuts and finishes with the mouse and the keyboard.
#include <X11/keysym.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>

#include "support/temp_folder.h"
#include "viz/measuring.h"
#include "viz/model_window.h"

namespace tessera {
namespace {

constexpr Rgb8 kGreen{20, 220, 20}, kRed{220, 20, 20};

void AddSquare(TriangleMesh& mesh, const std::array<Eigen::Vector3f, 4>& corners, Rgb8 colour) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& corner : corners) {
        mesh.vertices.push_back(corner);
        mesh.colours.push_back(colour);
    }
    mesh.triangles.push_back({first, first + 3, first + 1});
    mesh.triangles.push_back({first + 1, first + 3, first + 2});
}

class ViewerMeasure : public testing_support::ModelWindow {
  protected:
    // A wall: a green square of 2 m, facing the camera at the origin.
    void SetUp() override {
        ModelWindow::SetUp();
        if (!display_) return;
        AddSquare(model_.mesh, {{{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}}}, kGreen);
        model_.path.push_back(Eigen::Isometry3d::Identity());
    }
    void Open() { ModelWindow::Open(model_, file_); }
    static bool Like(const Rgb8& c, const Rgb8& colour) {
        const int high = colour.g > colour.r ? c.g : c.r, low = colour.g > colour.r ? c.r : c.g;
        return high > 60 && high > 2 * low && high > 2 * c.b;
    }
    // The pixels of that colour in the 3D view.
    std::vector<Eigen::Vector2i> Pixels(Rgb8 colour) {
        const ColourImage picture = viewer_->Picture();
        std::vector<Eigen::Vector2i> pixels;
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x)
                if (Like(picture(x, y), colour)) pixels.emplace_back(x, y);
        return pixels;
    }
    double Count(Rgb8 colour) { return static_cast<double>(Pixels(colour).size()); }
    // The pixel of the square that lies farthest in a direction of the picture: its corner.
    Eigen::Vector2i Corner(const std::vector<Eigen::Vector2i>& pixels, int x, int y) const {
        return *std::ranges::max_element(
            pixels, {}, [=](const Eigen::Vector2i& p) { return x * p.x() + y * p.y(); });
    }
    void ClickAt(const Eigen::Vector2i& at) {
        display_->MoveTo(static_cast<float>(at.x()), static_cast<float>(at.y()));
        Rounds(3);
        display_->Press(1);
        Rounds(2);
        display_->Release(1);
        Rounds(4);
    }
    std::vector<Measurement> Saved() const {
        const Result<std::vector<Measurement>> read = ReadMeasurements(file_);
        return read.ok() ? read.value() : std::vector<Measurement>();
    }

    TempFolder folder_;
    const std::string file_ = folder_.path() + "/measurements.json";
    ViewedModel model_;
};

TEST_F(ViewerMeasure, AWallsWidthAreaAndVolume) {
    Open();
    const std::vector<Eigen::Vector2i> pixels = Pixels(kGreen);
    ASSERT_GT(pixels.size(), 1000u);
    const std::array corners = {Corner(pixels, -1, -1), Corner(pixels, 1, -1), Corner(pixels, 1, 1),
                                Corner(pixels, -1, 1)};
    ClickAt(corners[0]);  // the tool is off
    Click("measure");
    EXPECT_FALSE(std::filesystem::exists(file_));
    // A pixel is 7 mm wide, and a click counts up to three pixels beside the surface.
    for (const Eigen::Vector2i& corner : corners) ClickAt(corner);
    ASSERT_EQ(Saved().size(), 1u);
    ASSERT_EQ(Saved()[0].corners.size(), 4u);
    EXPECT_FALSE(Saved()[0].closed);
    const Measurement line = Saved()[0];
    for (const Eigen::Vector3d& corner : line.corners) {
        EXPECT_NEAR(corner.z(), 3, 0.001);
        EXPECT_NEAR(std::abs(corner.x()), 1, 0.03);
        EXPECT_NEAR(std::abs(corner.y()), 1, 0.03);
    }
    EXPECT_NEAR(EdgesOf(line)[0].length_m(), 2, 0.05);
    ClickAt(corners[0]);
    ASSERT_EQ(Saved().size(), 1u);
    EXPECT_TRUE(Saved()[0].closed);
    EXPECT_NEAR(Area_m2(Saved()[0]), 4, 0.12);
    EXPECT_TRUE(FindControl("tools"));

    display_->PressKey(XK_Shift_L);
    Rounds(2);
    ClickAt((corners[0] + corners[2]) / 2);
    display_->ReleaseKey(XK_Shift_L);
    Rounds(2);
    ASSERT_EQ(Saved().size(), 1u);
    EXPECT_TRUE(Saved()[0].top);  // on the wall itself: no height
    EXPECT_NEAR(Height_m(Saved()[0]), 0, 0.001);
    MoveTo("view");
    Key(XK_BackSpace);
    ASSERT_EQ(Saved().size(), 1u);
    EXPECT_FALSE(Saved()[0].top);
    Click("measure.clear");
    EXPECT_TRUE(Saved().empty());
}

TEST_F(ViewerMeasure, KeysAndDrags) {
    Open();
    const std::vector<Eigen::Vector2i> pixels = Pixels(kGreen);
    const Eigen::Vector2i left = Corner(pixels, -1, -1), right = Corner(pixels, 1, 1),
                          middle = (left + right) / 2;
    MoveTo("view");
    Key(XK_l);
    ASSERT_TRUE(FindControl("tools"));
    ClickAt(left);
    ClickAt(middle);
    EXPECT_EQ(Saved().size(), 1u);
    Key(XK_Return);
    ClickAt(right);
    EXPECT_EQ(Saved().size(), 1u);  // one corner of the next
    ClickAt(middle);
    EXPECT_EQ(Saved().size(), 2u);
    Key(XK_BackSpace);
    EXPECT_EQ(Saved().size(), 1u);
    Key(XK_Escape);  // ends the tool, not the window
    EXPECT_FALSE(FindControl("tools"));
    EXPECT_TRUE(FindControl("measure"));
    EXPECT_EQ(Saved().size(), 1u);
    Key(XK_l);
    display_->MoveTo(static_cast<float>(left.x() + 30), static_cast<float>(left.y() + 30));
    Rounds(2);
    display_->Press(1);
    Rounds(2);
    display_->MoveTo(static_cast<float>(right.x() - 30), static_cast<float>(left.y() + 40));
    Rounds(3);
    display_->Release(1);  // a drag turns the view and is no click
    Rounds(3);
    Key(XK_Return);
    EXPECT_EQ(Saved().size(), 1u);
}

TEST_F(ViewerMeasure, EarlierMeasurementsAreThere) {
    Measurement wall;
    wall.corners = {{-1, 0, 3}, {1, 0, 3}};
    Measuring before;
    before.Open(file_);
    for (const Eigen::Vector3d& corner : wall.corners) before.Click(corner, false, false);
    const auto yellow = [&] {
        const ColourImage picture = viewer_->Picture();
        int count = 0;
        for (std::size_t i = 0; i < picture.size(); ++i) {
            const Rgb8& c = picture.data()[i];
            count += c.r > 200 && c.g > 160 && c.b < 140;
        }
        return count;
    };
    Open();
    EXPECT_GT(yellow(), 200);
    EXPECT_FALSE(FindControl("tools"));
    Click("measure");
    Click("measure.clear");
    EXPECT_LT(yellow(), 50);
}

// Two squares, the red one a metre higher and a metre nearer (y is down, z is forward).
TEST_F(ViewerMeasure, CutsHideWhatIsHigherOrNearer) {
    AddSquare(model_.mesh, {{{-1, -3, 2}, {1, -3, 2}, {1, -2, 2}, {-1, -2, 2}}}, kRed);
    Open();
    const double red = Count(kRed), green = Count(kGreen);
    ASSERT_GT(red, 500);
    ASSERT_GT(green, 500);
    EXPECT_FALSE(FindControl("cut.at"));
    Click("cut");
    Click("cut.at", 0.62f);  // between the two
    EXPECT_EQ(Count(kRed), 0);
    EXPECT_NEAR(Count(kGreen), green, 0.1 * green);
    Click("cut.at", 0.25f);  // through the middle of the lower one
    EXPECT_NEAR(Count(kGreen), green / 2, 0.2 * green);
    Click("cut.front");
    Click("cut.at", 0.5f);
    EXPECT_EQ(Count(kRed), 0);
    EXPECT_NEAR(Count(kGreen), green, 0.1 * green);
    Click("cut.at", 0.99f);
    EXPECT_NEAR(Count(kRed), red, 0.1 * red);
    Click("cut");
    EXPECT_EQ(Count(kRed), red);
    EXPECT_FALSE(FindControl("tools"));
}

TEST_F(ViewerMeasure, AModelIsFinishedWhileTheWindowGoesOn) {
    std::atomic<int> made = 0;
    std::atomic<bool> may_end = false;
    model_.finish = [&](const BackgroundJob::Progress& progress) -> Result<std::string> {
        while (!may_end)
            if (!progress("paint", 0.5)) return Status::Error("cancelled");
        if (++made == 2) return Status::Error("no paint");
        return std::string("made: model.glb");
    };
    Open();
    EXPECT_FALSE(FindControl("tools"));
    Click("finish");
    EXPECT_TRUE(FindControl("finish.running"));
    Click("finish");  // it runs already
    Click("cut");     // the window goes on
    EXPECT_TRUE(FindControl("cut.at"));
    EXPECT_TRUE(FindControl("finish.running"));
    Click("finish.cancel");
    ASSERT_TRUE(Within(20, [&] { return FindControl("finish.done").has_value(); }));
    EXPECT_EQ(made, 0);
    may_end = true;
    for (const char* const end : {"finish.done", "finish.failed"}) {
        Click("finish");
        ASSERT_TRUE(Within(20, [&] { return FindControl(end).has_value(); })) << end;
        Click(end);
        EXPECT_FALSE(FindControl(end));
    }
    EXPECT_EQ(made, 2);
    may_end = false;
    Click("finish");
    viewer_.reset();  // closing the window cancels
}

TEST_F(ViewerMeasure, AMeshAloneCannotBeFinished) {
    Open();
    EXPECT_FALSE(FindControl("finish"));
}

}  // namespace
}  // namespace tessera
