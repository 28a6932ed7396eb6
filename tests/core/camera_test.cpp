#include "core/camera.h"

#include <gtest/gtest.h>

#include <fstream>
#include <ostream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

Result<CameraCalibration> ReadText(const std::string& text) {
    const TempFolder folder;
    std::ofstream(folder / "camera.yaml") << text;
    return ReadCameraFile(folder / "camera.yaml");
}

constexpr const char* kIntrinsics = "fx: 500\nfy: 510\ncx: 310\ncy: 230\n";

TEST(Camera, ProjectsWhatItUnprojects) {
    const PinholeCamera camera{640, 480, 525, 520, 319.5, 239.5};
    const Eigen::Vector3d p = camera.Unproject(10, 400, 2.5);
    EXPECT_LT(
        (p - Eigen::Vector3d((10 - 319.5) / 525 * 2.5, (400 - 239.5) / 520 * 2.5, 2.5)).norm(),
        1e-15);
    EXPECT_LT((camera.Project(p) - Eigen::Vector2d(10, 400)).norm(), 1e-12);
    // The optical axis meets the image at the principal point.
    EXPECT_EQ(camera.Project({0, 0, 3}), Eigen::Vector2d(319.5, 239.5));
}

TEST(Camera, ImplausibleValuesAreNamed) {
    EXPECT_TRUE(CheckPlausible(PinholeCamera{}).ok());
    EXPECT_EQ(CheckPlausible(PinholeCamera{.fx = 0}).message(), "fx: 0 is not plausible");
    EXPECT_EQ(CheckPlausible(PinholeCamera{.width = 8}).message(), "width: 8 is not plausible");
    EXPECT_EQ(CheckPlausible(PinholeCamera{.cx = 641}).message(),
              "cx: 641 is not plausible, it is outside the image (0 to 640)");
    EXPECT_EQ(CheckPlausible(PinholeCamera{.cy = -1}).message(),
              "cy: -1 is not plausible, it is outside the image (0 to 480)");
}

TEST(CameraFile, ReadsEveryKey) {
    const auto camera =
        ReadText(std::string("width: 320\nheight: 240\n") + kIntrinsics +
                 "distortion: [0.1, -0.2, 0.003, -0.004, 0.5]\ndepth_scale: 1000\nfps: 25\n"
                 "vignetting: 0.2\n");
    ASSERT_TRUE(camera.ok()) << camera.message();
    EXPECT_EQ(camera.value().pinhole, (PinholeCamera{320, 240, 500, 510, 310, 230}));
    EXPECT_EQ(camera.value().distortion, (LensDistortion{0.1, -0.2, 0.003, -0.004, 0.5}));
    EXPECT_EQ(camera.value().depth_scale, 1000);
    EXPECT_EQ(camera.value().fps, 25);
    EXPECT_EQ(camera.value().vignetting, 0.2);
}

constexpr const char* kColour =
    "colour: {fx: 600, fy: 601, cx: 330, cy: 250, T_colour_depth: [-0.025, 0.001, 0.002, 0, 0.6, "
    "0, 0.8]}\n";

TEST(CameraFile, AColourCameraOfItsOwn) {
    EXPECT_FALSE(ReadText(kIntrinsics).value().colour);
    const auto read = ReadText(std::string(kIntrinsics) + kColour);
    ASSERT_TRUE(read.ok()) << read.message();
    const ColourCamera& colour = *read.value().colour;
    EXPECT_EQ(colour.pinhole, (PinholeCamera{640, 480, 600, 601, 330, 250}));
    EXPECT_EQ(colour.T_colour_depth.translation(), Eigen::Vector3d(-0.025, 0.001, 0.002));
    // A rotation about y by twice the angle whose sine is 0.6.
    EXPECT_LT(
        (colour.T_colour_depth.linear() * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(0.96, 0, 0.28))
            .norm(),
        1e-12);
    CameraCalibration written = read.value();
    written.vignetting = 0.1;
    written.colour->distortion = {0.1, -0.2, 0.003, -0.004, 0.5};
    written.colour->pinhole.width = 720;
    const auto again = ReadText(CameraFileText(written));
    ASSERT_TRUE(again.ok()) << again.message();
    EXPECT_EQ(again.value().colour->pinhole, written.colour->pinhole);
    EXPECT_EQ(again.value().vignetting, 0.1);
    EXPECT_EQ(again.value().colour->distortion, written.colour->distortion);
    EXPECT_TRUE(again.value().colour->T_colour_depth.isApprox(colour.T_colour_depth, 1e-12));
}

TEST(CameraFile, DefaultsAreTumsAndAnIdealLens) {
    const auto camera = ReadText(kIntrinsics);
    ASSERT_TRUE(camera.ok()) << camera.message();
    EXPECT_EQ(camera.value().pinhole.width, 640);
    EXPECT_EQ(camera.value().pinhole.height, 480);
    EXPECT_EQ(camera.value().depth_scale, 5000);
    EXPECT_EQ(camera.value().fps, 30);
    EXPECT_TRUE(camera.value().distortion.IsZero());
    EXPECT_FALSE(camera.value().depth_scale_given);
    const auto four = ReadText(std::string(kIntrinsics) + "distortion: [0.1, 0.2, 0.3, 0.4]\n");
    ASSERT_TRUE(four.ok()) << four.message();
    EXPECT_EQ(four.value().distortion, (LensDistortion{0.1, 0.2, 0.3, 0.4, 0}));
}

TEST(CameraFile, ANegativeFyIsTakenAsPositive) {
    const auto camera = ReadText("fx: 481.2\nfy: -480\ncx: 319.5\ncy: 239.5\n");
    ASSERT_TRUE(camera.ok()) << camera.message();
    EXPECT_EQ(camera.value().pinhole.fy, 480);
}

struct BadFile {
    const char* text;
    const char* named;  // text that the message must contain
};
void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.named; }
class CameraFileBad : public testing::TestWithParam<BadFile> {};

TEST_P(CameraFileBad, NamesFileAndKey) {
    const auto camera = ReadText(GetParam().text);
    ASSERT_FALSE(camera.ok());
    EXPECT_NE(camera.message().find("/camera.yaml"), std::string::npos) << camera.message();
    EXPECT_NE(camera.message().find(GetParam().named), std::string::npos) << camera.message();
    EXPECT_EQ(camera.message().find('\n'), std::string::npos) << camera.message();
}

INSTANTIATE_TEST_SUITE_P(
    All, CameraFileBad,
    testing::Values(
        BadFile{"", "key: value"}, BadFile{"- 1\n- 2\n", "key: value"}, BadFile{"{", "yaml"},
        BadFile{"fy: 510\ncx: 310\ncy: 230\n", "'fx' is missing"},
        BadFile{"fx: 500\ncx: 310\ncy: 230\n", "'fy' is missing"},
        BadFile{"fx: 500\nfy: 510\ncy: 230\n", "'cx' is missing"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\n", "'cy' is missing"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nk1: 2\n", "unknown key 'k1'"},
        BadFile{"fx: wide\nfy: 510\ncx: 310\ncy: 230\n", "fx: 'wide' is not a number"},
        BadFile{"fx: [1]\nfy: 510\ncx: 310\ncy: 230\n", "fx: a list is not a number"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nfx: 501\n", "fx: is given twice"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nwidth: 640.5\n",
                "width: '640.5' is not a whole"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\n\"\\e[2J\": 1\n", "unknown key '\\x1b[2J'"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ndistortion: [1e30, 0, 0, 0]\n",
                "distortion: is not plausible"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ndistortion: [0, 0, 0, few]\n",
                "distortion: 'few' is not a number"},
        BadFile{"fx: 0\nfy: 510\ncx: 310\ncy: 230\n", "fx"},
        BadFile{"fx: -500\nfy: 510\ncx: 310\ncy: 230\n", "fx"},
        BadFile{"fx: 500\nfy: .nan\ncx: 310\ncy: 230\n", "fy"},
        BadFile{"fx: 500\nfy: 5\ncx: .inf\ncy: 230\n", "cx"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 5000\n", "cy"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nwidth: 0\n", "width"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nwidth: 99999999999\n", "width"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nheight: 100000\n", "height"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ndepth_scale: 0\n", "depth_scale"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nfps: -1\n", "fps"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ndistortion: [1, 2]\n", "distortion"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ndistortion: [1, 2, .nan, 4]\n", "distortion"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ndistortion: 3\n", "distortion"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\nvignetting: 1\n", "vignetting: 1 is not"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ncolour: yes\n", "colour: expected 'key: "},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ncolour: {fx: 1}\n", "colour: 'cx' is missing"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ncolour: {fx: 0, fy: 9, cx: 1, cy: 1}\n",
                "colour: fx: 0 is not"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ncolour: {fps: 3}\n",
                "colour: unknown key 'fps'"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\ncolour: {T_colour_depth: [1, 2]}\n",
                "colour: T_colour_depth: needs tx"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\n"
                "colour: {T_colour_depth: [0, 0, 0, 0, 0, 0, 2]}\n",
                "T_colour_depth: qx, qy, qz, qw is no rotation"},
        BadFile{"fx: 500\nfy: 510\ncx: 310\ncy: 230\n"
                "colour: {T_colour_depth: [3, 0, 0, 0, 0, 0, 1]}\n",
                "T_colour_depth: is not plausible"},
        BadFile{"[1, 2]: 3\n", "/camera.yaml"}));

TEST(CameraFile, AMissingFileIsNamed) {
    const auto camera = ReadCameraFile("/no/such/camera.yaml");
    ASSERT_FALSE(camera.ok());
    EXPECT_EQ(camera.message(), "/no/such/camera.yaml: no such file");
}

TEST(CameraFile, DeepNestingAndGarbageAreRefusedInOneReadableLine) {
    for (const std::string& text :
         {std::string(5000, '['), "fx: " + std::string(5000, '{'),
          std::string("\x1b[31m\x00\xff", 7), "fx: 1\n" + std::string(70000, ' ')}) {
        const auto camera = ReadText(text);
        ASSERT_FALSE(camera.ok());
        EXPECT_LT(camera.message().size(), 400u);
        EXPECT_EQ(camera.message().find('\x1b'), std::string::npos);
    }
}

// The published lenses of TUM's cameras, and a wide one.
TEST(CameraFile, RealLensesArePlausible) {
    for (const char* lens :
         {"[0.2624, -0.9531, -0.0054, 0.0026, 1.1633]",
          "[0.2312, -0.7849, -0.0033, -0.0001, 0.9172]", "[-0.35, 0.12, 0, 0]"}) {
        const auto camera = ReadText(std::string(kIntrinsics) + "distortion: " + lens + "\n");
        EXPECT_TRUE(camera.ok()) << camera.message();
    }
}

}  // namespace
}  // namespace tessera
