// A camera's results survive the next run into the same folder.
#include <filesystem>
#include <fstream>

#include "run/run_fixture.h"
#include "scan/database.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

class EarlierRun : public Run {
  protected:
    // As if the last run's frames had come from a camera.
    void SayItWasACamera() {
        nlohmann::ordered_json run = nlohmann::ordered_json::parse(ReadAll(Out("run.json")));
        run["source"]["name"] = "openni2:";
        std::ofstream(Out("run.json")) << run.dump(2);
    }
};

TEST_F(EarlierRun, OfACameraMovesAsideWithAllItsFiles) {
    ASSERT_TRUE(Execute().ok());
    std::ofstream(Out("measurements.json")) << "{}";
    std::ofstream(Out("trajectory_1.txt")) << "# of an earlier clock\n";
    std::ofstream(Out("notes.txt")) << "mine";
    SayItWasACamera();
    const std::string mesh = ReadAll(Out("mesh.ply")), path = ReadAll(Out("trajectory.txt"));
    config.synthetic.frames = 3;
    ASSERT_TRUE(Execute().ok());
    EXPECT_TRUE(ReadAll(Out("earlier_1/mesh.ply")) == mesh);
    EXPECT_EQ(ReadAll(Out("earlier_1/trajectory.txt")), path);
    for (const char* file : {"preview.png", "objects.json", "timings.json", "frames.csv",
                             "run.json", "measurements.json", "trajectory_1.txt"})
        EXPECT_TRUE(fs::exists(Out("earlier_1/") + file)) << file;
    EXPECT_TRUE(fs::exists(Out("notes.txt")));
    EXPECT_FALSE(fs::exists(Out("measurements.json")));
    EXPECT_NE(ReadAll(Out("trajectory.txt")), path);
    ASSERT_FALSE(warnings.empty());
    EXPECT_NE(warnings.back().find("earlier_1"), std::string::npos) << warnings.back();

    // That was a synthetic run, which can be repeated. The next camera's gets the next number.
    ASSERT_TRUE(Execute().ok());
    EXPECT_FALSE(fs::exists(Out("earlier_2")));
    SayItWasACamera();
    ASSERT_TRUE(Execute().ok());
    EXPECT_TRUE(fs::exists(Out("earlier_2/mesh.ply")));
    EXPECT_TRUE(ReadAll(Out("earlier_1/mesh.ply")) == mesh);
}

// The resumed scan covers the results of its own earlier run, and no others.
TEST_F(EarlierRun, OfAnotherRoomIsKeptFromAResumedScan) {
    if (!ScanAvailable()) GTEST_SKIP() << kScanUnavailable;
    request.scan_file = folder / "kitchen.scan";
    request.selection.count = 2;
    ASSERT_TRUE(Execute().ok());
    SayItWasACamera();
    request.resume = true;
    request.selection.count = 4;
    ASSERT_TRUE(Execute().ok());
    EXPECT_FALSE(fs::exists(Out("earlier_1")));

    const RunRequest kitchen = request;
    request.resume = false;
    request.scan_file.clear();
    ASSERT_TRUE(Execute().ok());
    SayItWasACamera();
    const std::string mesh = ReadAll(Out("mesh.ply"));
    request = kitchen;
    request.selection.count = 6;
    ASSERT_TRUE(Execute().ok());
    EXPECT_TRUE(ReadAll(Out("earlier_1/mesh.ply")) == mesh);
}

TEST_F(EarlierRun, ThatTrackedNothingIsNotKept) {
    ASSERT_TRUE(Execute().ok());
    SayItWasACamera();
    std::ofstream(Out("trajectory.txt")) << "# no pose\n";
    ASSERT_TRUE(Execute().ok());
    EXPECT_FALSE(fs::exists(Out("earlier_1")));
}

TEST_F(EarlierRun, StaysIfTheNextIsStoppedBeforeItsFirstFrame) {
    ASSERT_TRUE(Execute().ok());
    const std::string mesh = ReadAll(Out("mesh.ply")), run = ReadAll(Out("run.json"));
    stop = true;
    const auto stopped = Execute();
    ASSERT_TRUE(stopped.ok()) << stopped.message();
    EXPECT_EQ(stopped.value().counts.frames, 0);
    EXPECT_TRUE(ReadAll(Out("mesh.ply")) == mesh);
    EXPECT_EQ(ReadAll(Out("run.json")), run);
}

}  // namespace
}  // namespace tessera
