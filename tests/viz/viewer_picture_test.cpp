// Tests of the window's image.
#include <X11/keysym.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "io/image_io.h"
#include "viz/window_fixture.h"

namespace tessera {
namespace {

class ViewerPicture : public testing_support::WindowTest {
  protected:
    static int Spread(const Rgb8& c) {
        return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b});
    }
    double Difference(const ColourImage& a, const ColourImage& b) {
        double sum = 0;
        const ControlRect view = Find("view");
        for (int y = 60; y < static_cast<int>(view.height); ++y)
            for (int x = static_cast<int>(view.x); x < static_cast<int>(view.x + view.width); ++x)
                sum += std::abs(a(x, y).g - b(x, y).g);
        return sum / (view.width * view.height);
    }
};

TEST_F(ViewerPicture, TheMeshGrowsFromNothing) {
    EXPECT_EQ(Share(viewer_->Picture(), [](const Rgb8& c) { return !IsBackground(c); }), 0);
    Frames(3);
    const ColourImage picture = viewer_->Picture();
    ASSERT_EQ(picture.width(), 1280);
    ASSERT_EQ(picture.height(), 720);
    EXPECT_GT(Share(picture, [](const Rgb8& c) { return !IsBackground(c); }), 0.2);
}

TEST_F(ViewerPicture, AScreenshotIsSavedAndToldOf) {
    Frames(3);
    Click("screenshot");
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        files.push_back(entry.path());
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(files[0].filename().string().rfind("scan-", 0), 0u) << files[0];
    const auto picture = ReadColourImage(files[0].string());
    ASSERT_TRUE(picture.ok()) << picture.message();
    ASSERT_EQ(picture.value().width(), 1280);
    ASSERT_EQ(picture.value().height(), 720);
    // The box room has warm colours, which occur nowhere else in the window.
    EXPECT_GT(Share(picture.value(), [](const Rgb8& c) { return c.r > c.b + 15 && c.r > 70; }),
              0.05);
    Key(XK_p);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(ViewerPicture, ShadingByButtonAndKey) {
    Frames(3);
    const auto coloured = [&] {
        return Share(viewer_->Picture(),
                     [](const Rgb8& c) { return !IsBackground(c) && Spread(c) > 40; });
    };
    const auto red = [&] {
        return Share(viewer_->Picture(),
                     [](const Rgb8& c) { return c.r > 90 && c.r > 3 * c.g && c.r > 3 * c.b; });
    };
    const double colour = coloured(), red_of_scene = red();
    Click("shading.Label");  // half of the room has a label
    const double labelled = red();
    EXPECT_GT(labelled, red_of_scene + 0.05);
    Click("shading.Weight");  // seen once or twice, so the dark end of the scale
    EXPECT_LT(red(), 0.01);
    EXPECT_GT(Share(viewer_->Picture(), [](const Rgb8& c) { return c.b > c.r + 20 && c.b > 60; }),
              0.15);
    Click("shading.Grey");
    const double grey = coloured();
    Click("shading.Normal");
    const double normal = coloured();
    EXPECT_LT(grey, 0.03);  // only the lines
    EXPECT_GT(colour, grey);
    EXPECT_GT(normal, 2 * grey + 0.05);
    Key(XK_c);  // the coverage
    Key(XK_c);
    MoveTo("view", 0.05f);  // no tooltip over the view
    EXPECT_NEAR(coloured(), colour, 0.01);
}

constexpr Rgb8 kMagenta{255, 0, 255};
bool IsMagenta(const Rgb8& c) { return c.r > 150 && c.b > 150 && c.g < 90; }

// The object's box and name show. A click in the list centres the object. They stay with another
// shading, and the key hides them.
TEST_F(ViewerPicture, AnObjectIsListedBoxedAndLookedAt) {
    Frames(3);
    const auto magenta = [&] { return Share(viewer_->Picture(), IsMagenta); };
    EXPECT_EQ(magenta(), 0);
    EXPECT_FALSE(viewer_->FindControl("object.7"));
    MapObject object;
    object.id = 7;
    object.class_name = "cup";
    object.colour = kMagenta;
    object.probability = 0.8;
    object.observations = 9;
    object.centroid = {0.3, 0.2, 1.2};
    object.T_world_oriented.translation() = object.centroid;
    object.oriented_size = {0.2, 0.2, 0.2};
    link_.objects.Push({object});
    Rounds(4);
    EXPECT_GT(magenta(), 0);
    Click("object.7");
    const ColourImage picture = viewer_->Picture();
    const ControlRect view = Find("view");
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    int count = 0;
    for (int y = static_cast<int>(view.y) + 60; y < static_cast<int>(view.y + view.height); ++y)
        for (int x = static_cast<int>(view.x); x < static_cast<int>(view.x + view.width); ++x)
            if (IsMagenta(picture(x, y))) mean += Eigen::Vector2d(x, y), ++count;
    ASSERT_GT(count, 50);
    EXPECT_NEAR(mean.x() / count, view.x + view.width / 2, 15);
    EXPECT_NEAR(mean.y() / count, view.y + view.height / 2, 15);
    MoveTo("view", 0.05f);
    Key(XK_b);
    EXPECT_EQ(magenta(), 0);
    Key(XK_b);
    link_.objects.Push({});
    Rounds(4);
    EXPECT_EQ(magenta(), 0);
    EXPECT_FALSE(viewer_->FindControl("object.7"));
}

// Detections are drawn over the image of their frame. Old detections are not shown over a new
// image.
TEST_F(ViewerPicture, DetectionsShowOverTheImage) {
    Frames(2);
    const auto magenta = [&] {
        const ColourImage picture = viewer_->Picture();
        const ControlRect view = Find("view");
        int count = 0;
        for (int y = 0; y < 170; ++y)
            for (int x = static_cast<int>(view.x + view.width) + 1; x < picture.width(); ++x)
                count += IsMagenta(picture(x, y));
        return count;
    };
    EXPECT_EQ(magenta(), 0);
    LabelUpdate update;
    update.stamp_s = 1.0 / 30;
    update.detections.push_back({{20, 20, 60, 60}, "cup", 0.9f, kMagenta});
    link_.labels.Push(LabelUpdate(update));
    Rounds(4);
    EXPECT_GT(magenta(), 100);
    update.stamp_s = -10;
    link_.labels.Push(LabelUpdate(update));
    Rounds(4);
    EXPECT_EQ(magenta(), 0);
}

TEST_F(ViewerPicture, WireframeShowsThrough) {
    Frames(3);
    const auto covered = [&] {
        return Share(viewer_->Picture(), [](const Rgb8& c) { return !IsBackground(c); });
    };
    Click("view_all");
    MoveTo("view", 0.05f);  // no tooltip over the view
    const double filled = covered();
    Click("wireframe");
    EXPECT_NE(covered(), filled);
    MoveTo("view", 0.05f);
    Key(XK_w);
    EXPECT_NEAR(covered(), filled, 1e-9);
}

TEST_F(ViewerPicture, ThePointerTurnsMovesAndZooms) {
    Frames(3);
    MoveTo("view");
    const ControlRect view = Find("view");
    const float x = view.x + view.width / 2, y = view.y + view.height / 2;
    ColourImage before = viewer_->Picture();
    const auto drag = [&](int button) {
        display_->MoveTo(x, y);
        Rounds(2);
        display_->Press(button);
        Rounds(2);
        display_->MoveTo(x + 60, y + 20);
        Rounds(3);
        display_->Release(button);
        Rounds(3);
    };
    const auto expect_change = [&](const char* what) {
        ColourImage after = viewer_->Picture();
        EXPECT_GT(Difference(before, after), 1) << what;
        before = std::move(after);
    };
    drag(1);
    expect_change("turn");
    drag(2);
    expect_change("middle");
    display_->PressKey(XK_Shift_L);
    drag(1);
    display_->ReleaseKey(XK_Shift_L);
    expect_change("shift");
    display_->Press(4);
    display_->Release(4);
    Rounds(3);
    expect_change("wheel");
    Key(XK_a);
    expect_change("all");
    for (int i = 0; i < 2; ++i) {
        display_->Press(1);
        Rounds(1);
        display_->Release(1);
        Rounds(1);
    }
    Rounds(3);
    expect_change("double click");
    Key(XK_f);
    Frames(1);
    expect_change("follow");
}

}  // namespace
}  // namespace tessera
