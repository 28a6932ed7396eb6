// What the window shows.
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
    // Of the 3D view's pixels, the share for which the predicate holds.
    template <class Predicate>
    double Share(const ColourImage& picture, Predicate predicate) {
        const ControlRect view = Find("view");
        int all = 0, hits = 0;
        for (int y = static_cast<int>(view.y) + 60; y < static_cast<int>(view.y + view.height); ++y)
            for (int x = static_cast<int>(view.x); x < static_cast<int>(view.x + view.width); ++x, ++all)
                hits += predicate(picture(x, y));
        return static_cast<double>(hits) / all;
    }
    static int Spread(const Rgb8& c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); }
    static bool IsBackground(const Rgb8& c) { return std::max({c.r, c.g, c.b}) < 62; }
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
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) files.push_back(entry.path());
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(files[0].filename().string().rfind("scan-", 0), 0u) << files[0];
    const auto picture = ReadColourImage(files[0].string());
    ASSERT_TRUE(picture.ok()) << picture.message();
    ASSERT_EQ(picture.value().width(), 1280);
    ASSERT_EQ(picture.value().height(), 720);
    // The box room: warm colours, which no part of the window's own has.
    EXPECT_GT(Share(picture.value(), [](const Rgb8& c) { return c.r > c.b + 15 && c.r > 70; }), 0.05);
    Key(XK_p);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(ViewerPicture, ShadingByButtonAndKey) {
    Frames(3);
    const auto coloured = [&] {
        return Share(viewer_->Picture(), [](const Rgb8& c) { return !IsBackground(c) && Spread(c) > 40; });
    };
    const double colour = coloured();
    Click("shading.Grey");
    const double grey = coloured();
    Click("shading.Normal");
    const double normal = coloured();
    EXPECT_LT(grey, 0.03);  // the lines only
    EXPECT_GT(colour, grey);
    EXPECT_GT(normal, 2 * grey + 0.05);
    Key(XK_c);
    EXPECT_NEAR(coloured(), colour, 0.01);
}

TEST_F(ViewerPicture, WireframeShowsThrough) {
    Frames(3);
    const auto covered = [&] { return Share(viewer_->Picture(), [](const Rgb8& c) { return !IsBackground(c); }); };
    Click("view_all");
    const double filled = covered();
    Click("wireframe");
    EXPECT_NE(covered(), filled);
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
