// Runs that are refused or track nothing: what they say, and the files they leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "run/run.h"
#include "run/run_fixture.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

TEST_F(Run, BadInputIsAnErrorThatNamesIt) {
    request.poses_file = folder / "none.txt";
    EXPECT_NE(Execute().message().find("none.txt"), std::string::npos);
    request.poses_file.clear();
    std::ofstream(folder / "file") << "x";
    request.output_folder = folder / "file/out";
    EXPECT_NE(Execute().message().find("file"), std::string::npos) << Execute().message();
    request.output_folder = folder / "out";
    config.pipeline.map.truncation_m = 0.01;
    EXPECT_NE(Execute().message().find("mapping.truncation_m"), std::string::npos);
}

TEST_F(Run, ARefusedRunSaysOneThingAndLeavesEarlierResults) {
    ASSERT_TRUE(Execute().ok());
    const std::string mesh = ReadAll(Out("mesh.ply"));
    request.selection.start = 1000;
    observer.on_open = [](const SourceInfo&) { ADD_FAILURE() << "on_open was called"; };
    EXPECT_NE(Execute().message().find("1000"), std::string::npos);
    EXPECT_TRUE(ReadAll(Out("mesh.ply")) == mesh);
}

TEST_F(Run, FilesThatAreNotOfARunAreNotReplaced) {
    fs::create_directories(request.output_folder);
    observer.on_open = [](const SourceInfo&) { ADD_FAILURE() << "on_open was called"; };
    for (const char* name : {"detections.txt", "objects.json", "mesh.ply", "trajectory_1.txt"}) {
        std::ofstream(Out(name)) << "mine";
        const std::string why = Execute().message();
        EXPECT_NE(why.find(Out(name) + ": would be replaced"), std::string::npos) << why;
        EXPECT_NE(why.find("--out"), std::string::npos) << why;
        EXPECT_EQ(ReadAll(Out(name)), "mine");
        EXPECT_FALSE(fs::exists(Out("run.json")));
        fs::remove(Out(name));
    }
    observer.on_open = {};
    // A run that was killed had written run.json first.
    std::ofstream(Out("notes.txt")) << "mine";
    std::ofstream(Out("detections.txt")) << "its";
    std::ofstream(Out("run.json")) << R"({"exit": "unfinished"})";
    ASSERT_TRUE(Execute().ok());
    EXPECT_FALSE(fs::exists(Out("detections.txt")));
    EXPECT_EQ(ReadAll(Out("notes.txt")), "mine");
}

TEST_F(Run, TheRecordingsOwnFolderIsRefused) {
    request.record_path = folder / "raw";
    ASSERT_TRUE(Execute().ok());
    request.record_path.clear();
    request.source = folder / "raw";
    request.output_folder = folder / "out/../raw";
    std::ofstream(folder / "raw/run.json") << "{}";  // as earlier versions left one
    std::ofstream(folder / "raw/detections.txt") << "mine";
    const std::string why = Execute().message();
    EXPECT_NE(why.find("is the folder of the recording itself"), std::string::npos) << why;
    EXPECT_EQ(ReadAll(folder / "raw/detections.txt"), "mine");
    EXPECT_EQ(ReadAll(folder / "raw/run.json"), "{}");
}

// Its window never opens, so nobody would close it.
TEST_F(Run, ARefusedRunDoesNotWaitForAWindow) {
    ViewerLink link;
    link.open = true;
    request.viewer = &link;
    request.output_folder = "/proc/no";
    std::atomic<bool> done{false};
    std::jthread watch([&] {
        for (int i = 0; i < 600 && !done; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        stop = !done;
    });
    const auto run = Execute();
    done = true;
    EXPECT_FALSE(run.ok());
    EXPECT_FALSE(stop);
}

TEST_F(Run, DepthsOutOfRangeAreNamedOnceAndLost) {
    config.pipeline.frame.min_depth_m = 50;
    config.pipeline.frame.max_depth_m = 60;
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.tracked, 0);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("is depth_scale right?"), std::string::npos);
    EXPECT_TRUE(fs::exists(Out("run.json")));
}

TEST_F(Run, ClassesThatTheDetectorCannotFindAreTold) {
    request.labels = "synthetic";
    config.labels.classes = "cup sofa tv";
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(
        std::ranges::count(warnings, std::string("labels.classes: the detector does not know, or "
                                                 "labels.dynamic takes: sofa, tv")),
        1);
    EXPECT_NE(ReadAll(Out("detections.txt"))
                  .find("# classes cup\n# aliases monitor=computer tvmonitor=computer\n"),
              std::string::npos);
}

}  // namespace
}  // namespace tessera
