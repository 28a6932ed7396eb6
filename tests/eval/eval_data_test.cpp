// Tests of the evaluation on real data. The files are not part of the project: see README, "Data".
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "eval/ate.h"
#include "eval/mesh_error.h"
#include "eval/rpe.h"
#include "eval/test_trajectories.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"

namespace tessera {
namespace {

std::string DataPath(const std::string& name) {
    const char* root = std::getenv("TESSERA_DATA");
    return (std::filesystem::path(root ? root : TESSERA_DEFAULT_DATA) / name).string();
}

#define SKIP_WITHOUT(path)                                                      \
    if (!std::filesystem::exists(path))                                         \
    GTEST_SKIP()                                                                \
        << path << " is absent: set TESSERA_DATA to a folder with TUM RGB-D's " \
        << "freiburg1_rpy as tum_fr1_rpy (https://cvg.cit.tum.de/data/datasets/rgbd-dataset)"

TEST(EvalData, GroundTruthAgainstItself) {
    const std::string path = DataPath("tum_fr1_rpy/groundtruth.txt");
    SKIP_WITHOUT(path);
    const auto truth = ReadTrajectory(path);
    ASSERT_TRUE(truth.ok()) << truth.message();
    const auto& poses = truth.value().poses;
    for (const auto& estimate : {poses, Moved(poses, SomeTransform())}) {
        const auto ate = EvaluateAte(poses, estimate);
        ASSERT_TRUE(ate.ok()) << ate.message();
        EXPECT_LT(ate.value().error_m.max, 1e-11);
        EXPECT_EQ(ate.value().pairs.size(), poses.size());
        const auto rpe = EvaluateRpe(poses, estimate);
        ASSERT_TRUE(rpe.ok()) << rpe.message();
        EXPECT_LT(rpe.value().trans_m.max, 1e-11);
    }
}

TEST(EvalData, ReferenceMeshAgainstItself) {
    const std::string path = DataPath("house_desk/reference.ply");
    SKIP_WITHOUT(path);
    const auto mesh = ReadPly(path);
    ASSERT_TRUE(mesh.ok()) << mesh.message();
    EXPECT_EQ(mesh.value().vertices.size(), 8505u);
    EXPECT_EQ(mesh.value().triangles.size(), 14877u);
    const auto result = MeasureMeshError(mesh.value(), mesh.value());
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_LT(result.value().accuracy_m.max, 1e-6);
    EXPECT_EQ(result.value().completeness, 1.0);
}

}  // namespace
}  // namespace tessera
