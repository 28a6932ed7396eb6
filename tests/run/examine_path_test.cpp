#include "run/examine_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "io/file.h"
#include "io/mesh_io.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

class ExaminedPaths : public testing::Test {
  protected:
    static ExaminedPath Examine(const std::string& path) { return ExaminePath(path, RunConfig()); }
    void WriteMesh(const std::string& path) const {
        TriangleMesh mesh;
        mesh.vertices = {{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}};
        mesh.triangles = {{0, 2, 1}};
        ASSERT_TRUE(WritePly(path, mesh).ok());
    }
    TempFolder folder_;
};

TEST_F(ExaminedPaths, ASourceCanBeRun) {
    const ExaminedPath found = Examine("synthetic:desk");
    EXPECT_TRUE(found.can_run);
    EXPECT_FALSE(found.can_view);
    EXPECT_NE(found.text.find("640 x 480"), std::string::npos) << found.text;
}

TEST_F(ExaminedPaths, AMeshAndARunAreShown) {
    WriteMesh(folder_ / "a.ply");
    std::filesystem::create_directory(folder_ / "run");
    WriteMesh(folder_ / "run/mesh.ply");
    for (const bool record : {false, true}) {
        if (record) {
            ASSERT_TRUE(WriteTextFile(folder_ / "run/run.json", "{}").ok());
        }
        for (const char* name : {"a.ply", "run"}) {
            const ExaminedPath found = Examine(folder_ / name);
            EXPECT_TRUE(found.can_view) << name;
            EXPECT_FALSE(found.can_run) << name;
            EXPECT_FALSE(found.failed) << name;
        }
    }
}

TEST_F(ExaminedPaths, ACameraIsNotOpened) {
    for (const char* name : {"openni2:", "pipe:/no/such/pipe"}) EXPECT_TRUE(Examine(name).can_run);
}

TEST_F(ExaminedPaths, WhatIsWrongIsOneLine) {
    std::filesystem::create_directory(folder_ / "empty");
    std::filesystem::create_directories(folder_ / "bad/rgb");
    ASSERT_TRUE(WriteTextFile(folder_ / "bad/camera.yaml", "fx: [\n\x1b[31m").ok());
    ASSERT_TRUE(WriteTextFile(folder_ / "no.scan", "nothing").ok());
    for (const std::string& path : {folder_ / "empty", folder_ / "bad", folder_ / "no.scan",
                                    std::string("/no/such"), std::string("gopher:x")}) {
        const ExaminedPath found = Examine(path);
        EXPECT_TRUE(found.failed) << path;
        EXPECT_FALSE(found.can_run || found.can_view) << path;
        EXPECT_FALSE(found.text.empty()) << path;
        EXPECT_EQ(std::ranges::count(found.text, '\n'), 0) << found.text;
        EXPECT_EQ(std::ranges::count(found.text, '\x1b'), 0) << found.text;
    }
}

TEST_F(ExaminedPaths, OtherFilesAreNamed) {
    ASSERT_TRUE(WriteTextFile(folder_ / "a.onnx", "x").ok());
    const ExaminedPath found = Examine(folder_ / "a.onnx");
    EXPECT_TRUE(found.failed);
    EXPECT_NE(found.text.find("detection network"), std::string::npos) << found.text;
}

}  // namespace
}  // namespace tessera
