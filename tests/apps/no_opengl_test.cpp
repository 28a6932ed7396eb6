// The program on a machine without OpenGL: the loader of EGL is told to look for drivers where
// there are none.
#include "apps/cli_fixture.h"

namespace tessera {
namespace {

const std::string kWithout = "__EGL_VENDOR_LIBRARY_FILENAMES=/no/such/driver.json ";

std::size_t Count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

TEST_F(Cli, WithoutOpenGlLabelsArePredictedByRayCasting) {
    if (Call("doctor", kWithout).out.find("OpenGL       off") == std::string::npos)
        GTEST_SKIP() << "this EGL loader finds its drivers without being told";
    const std::string run = SmallRun() + "--frames 8 --labels synthetic --out ";
    const Outcome cast = Call(run + (folder / "cast"));
    const Outcome drawn =
        Call(run + (folder / "drawn") + " --set labels.prediction=raster", kWithout);
    ASSERT_EQ(cast.exit_code, 0) << cast.err;
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_EQ(Count(cast.err, "predicting labels by ray casting"), 0u) << cast.err;
    EXPECT_EQ(Count(drawn.err, "predicting labels by ray casting: cannot create an OpenGL"), 1u)
        << drawn.err;
    EXPECT_EQ(ReadAll(folder / "cast/mesh.ply"), ReadAll(folder / "drawn/mesh.ply"));
    EXPECT_EQ(ReadAll(folder / "cast/objects.json"), ReadAll(folder / "drawn/objects.json"));
}

}  // namespace
}  // namespace tessera
