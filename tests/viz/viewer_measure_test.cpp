// Measures, cuts and finishes with the mouse and the keyboard.
#include <X11/keysym.h>

#include <atomic>
#include <filesystem>

#include "viz/measure_window.h"

namespace tessera {
namespace {

using testing_support::AddSquare;
using testing_support::kGreen;
using testing_support::kRed;
using ViewerMeasure = testing_support::MeasureWindow;

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

// There is no area yet that the click could make.
TEST_F(ViewerMeasure, AClickBesideTheFirstCornerIsNoCorner) {
    Open();
    const std::vector<Eigen::Vector2i> pixels = Pixels(kGreen);
    const Eigen::Vector2i first = Corner(pixels, -1, -1), last = Corner(pixels, 1, 1),
                          beside = first - Eigen::Vector2i(5, 5);
    Click("measure");
    ClickAt(first);
    ClickAt(beside);
    ClickAt((first + last) / 2);
    ASSERT_EQ(Saved().size(), 1u);
    EXPECT_EQ(Saved()[0].corners.size(), 2u);
    ClickAt(beside);
    EXPECT_EQ(Saved()[0].corners.size(), 2u);
    ClickAt(Corner(pixels, 1, -1));
    ClickAt(beside);  // now it makes the area
    EXPECT_EQ(Saved()[0].corners.size(), 3u);
    EXPECT_TRUE(Saved()[0].closed);
}

TEST_F(ViewerMeasure, ASurfaceThatOneSeesThroughCanBeMeasured) {
    Open();
    const std::vector<Eigen::Vector2i> pixels = Pixels(kGreen);
    const Eigen::Vector2i left = Corner(pixels, -1, -1), right = Corner(pixels, 1, 1);
    MoveTo("view");
    Key(XK_d);
    const auto green = static_cast<double>(pixels.size());
    EXPECT_NEAR(Count(kGreen), green, 0.02 * green);
    Click("measure");
    ClickAt((3 * left + right) / 4);
    ClickAt((left + 3 * right) / 4);
    const std::vector<Measurement> saved = Saved();
    ASSERT_EQ(saved.size(), 1u);
    ASSERT_EQ(saved[0].corners.size(), 2u);
    for (const Eigen::Vector3d& corner : saved[0].corners) EXPECT_NEAR(corner.z(), 3, 0.001);
}

// There is no list of messages.
TEST_F(ViewerMeasure, APictureOfAModelIsToldOf) {
    Open();
    EXPECT_FALSE(FindControl("message"));
    Key(XK_p);
    EXPECT_TRUE(FindControl("message"));
    int pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        pictures += entry.path().filename().string().starts_with("scan-");
    EXPECT_EQ(pictures, 1);
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
