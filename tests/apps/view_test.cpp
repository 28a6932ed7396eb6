// Tests `tessera view`, with and without a display.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "support/temp_folder.h"
#include "viz/virtual_display.h"

namespace tessera {
namespace {

class View : public testing::Test {
  protected:
    // Writes the folder of a run: a red square, in metres, and a path in front of it.
    View() {
        TriangleMesh mesh;
        mesh.vertices = {{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}};
        mesh.colours.assign(4, Rgb8{220, 40, 30});
        mesh.triangles = {{0, 3, 1}, {1, 3, 2}};  // wound to face the origin
        EXPECT_TRUE(WritePly(folder_ / "mesh.ply", mesh).ok());
        std::vector<StampedPose> poses(2);
        poses[1].stamp_s = 1;
        poses[1].T_world_camera.translation().x() = 0.3;
        EXPECT_TRUE(WriteTrajectory(folder_ / "trajectory.txt", poses).ok());
    }
    int Call(const std::string& arguments) {
        const std::string command =
            std::string(TESSERA_PROGRAM) + " view " + arguments + " 2>" + (folder_ / "stderr");
        const int status = std::system(command.c_str());
        std::stringstream text;
        text << std::ifstream(folder_ / "stderr").rdbuf();
        error_ = text.str();
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    TempFolder folder_;
    std::string error_;
};

TEST_F(View, AScreenshotShowsTheMesh) {
    std::string why;
    const auto display = testing_support::VirtualDisplay::Start(why);
    if (!display) GTEST_SKIP() << why;
    for (const std::string& path : {folder_.path(), folder_ / "mesh.ply"}) {
        ASSERT_EQ(
            Call(path + " --screenshot " + (folder_ / "shot.png") + " --width 640 --height 480"), 0)
            << error_;
        const auto picture = ReadColourImage(folder_ / "shot.png");
        ASSERT_TRUE(picture.ok()) << picture.message();
        ASSERT_EQ(picture.value().width(), 640);
        ASSERT_EQ(picture.value().height(), 480);
        int red = 0;
        for (std::size_t i = 0; i < picture.value().size(); ++i) {
            const Rgb8& c = picture.value().data()[i];
            red += c.r > 120 && c.g < 80;
        }
        EXPECT_GT(red, 640 * 480 / 12);
    }
}

// Another path over the mesh does not make it less of a run: the time line is there.
TEST_F(View, ARunHasItsTimeLineWhateverPathIsDrawn) {
    std::string why;
    const auto display = testing_support::VirtualDisplay::Start(why);
    if (!display) GTEST_SKIP() << why;
    std::vector<StampedPose> poses(2);
    poses[1].stamp_s = 1;
    poses[1].T_world_camera.translation().y() = 0.2;
    ASSERT_TRUE(WriteTrajectory(folder_ / "other.txt", poses).ok());
    std::vector<ColourImage> pictures;
    for (const std::string& option : {std::string(), " --trajectory " + (folder_ / "other.txt")}) {
        ASSERT_EQ(Call(folder_.path() + option + " --screenshot " + (folder_ / "shot.png")), 0)
            << error_;
        auto picture = ReadColourImage(folder_ / "shot.png");
        ASSERT_TRUE(picture.ok()) << picture.message();
        pictures.push_back(std::move(picture.value()));
    }
    const int width = pictures[0].width(), height = pictures[0].height();
    int differ = 0;  // in the lowest rows, where the time line is
    for (int y = height - 60; y < height; ++y)
        for (int x = 0; x < width; ++x)
            differ += std::abs(pictures[0](x, y).g - pictures[1](x, y).g) > 8;
    EXPECT_EQ(differ, 0);
}

TEST_F(View, WithoutADisplayItIsOneLine) {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    for (const std::string& path : {folder_.path(), std::string()}) {
        EXPECT_EQ(Call(path), 2);
        EXPECT_NE(error_.find("display"), std::string::npos) << error_;
        EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
    }
}

TEST_F(View, AScreenshotNeedsAPath) {
    EXPECT_EQ(Call("--screenshot " + (folder_ / "shot.png")), 2);
    EXPECT_NE(error_.find("PATH"), std::string::npos) << error_;
}

}  // namespace
}  // namespace tessera
