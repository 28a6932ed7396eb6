#include "io/mesh_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/input_file.h"
#include "io/file.h"

namespace tessera {
namespace {

// Tests run in parallel, so each uses its own file.
std::string MeshPath() {
    return testing::TempDir() + "mesh_io_" +
           testing::UnitTest::GetInstance()->current_test_info()->name() + ".ply";
}

Result<TriangleMesh> ReadBytes(const std::string& bytes) {
    const std::string path = MeshPath();
    EXPECT_TRUE(WriteTextFile(path, bytes).ok());
    return ReadPly(path);
}

// The bytes of `value`, in little-endian or big-endian order.
template <class T>
std::string Bytes(T value, bool big_endian) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
    if (big_endian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

TriangleMesh Tetrahedron() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0.25f}, {0, 1e-7f, 0}, {0, 0, -3}};
    mesh.normals = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0.6f, 0, 0.8f}};
    mesh.colours = {{0, 1, 2}, {255, 128, 7}, {9, 8, 7}, {1, 1, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return mesh;
}

constexpr char kAsciiHead[] =
    "ply\nformat ascii 1.0\nelement vertex 4\n"
    "property float x\nproperty float y\nproperty float z\n";

TEST(MeshIo, RoundTripKeepsEveryBit) {
    for (const bool with_normals : {false, true})
        for (const bool with_colours : {false, true}) {
            TriangleMesh mesh = Tetrahedron();
            if (!with_normals) mesh.normals.clear();
            if (!with_colours) mesh.colours.clear();
            const std::string path = MeshPath();
            ASSERT_TRUE(WritePly(path, mesh).ok());
            const auto back = ReadPly(path);
            ASSERT_TRUE(back.ok()) << back.message();
            EXPECT_EQ(back.value().vertices, mesh.vertices);
            EXPECT_EQ(back.value().normals, mesh.normals);
            EXPECT_EQ(back.value().colours, mesh.colours);
            EXPECT_EQ(back.value().triangles, mesh.triangles);
        }
}

TEST(MeshIo, EmptyMeshRoundTrip) {
    const std::string path = MeshPath();
    ASSERT_TRUE(WritePly(path, {}).ok());
    const auto back = ReadPly(path);
    ASSERT_TRUE(back.ok()) << back.message();
    EXPECT_TRUE(back.value().vertices.empty());
}

TEST(MeshIo, LargerThanTheWriteBuffer) {
    TriangleMesh mesh;
    for (int i = 0; i < 200000; ++i) mesh.vertices.push_back({static_cast<float>(i), 0, 1});
    const std::string path = MeshPath();
    ASSERT_TRUE(WritePly(path, mesh).ok());
    const auto back = ReadPly(path);
    ASSERT_TRUE(back.ok()) << back.message();
    EXPECT_EQ(back.value().vertices, mesh.vertices);
}

TEST(MeshIo, DiskFull) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full (Linux)";
    EXPECT_NE(WritePly("/dev/full", Tetrahedron()).message().find("no space"), std::string::npos);
}

TEST(MeshIo, AsciiWithPolygonsFloatColoursAndUnknownProperties) {
    const auto result = ReadBytes(
        "ply\r\nformat ascii 1.0\r\ncomment a remark\r\nelement material 1\r\n"
        "property list uchar float shades\r\nproperty int id\r\nelement vertex 4\r\n"
        "property double x\r\nproperty double y\r\nproperty double z\r\nproperty float quality\r\n"
        "property float red\r\nproperty float green\r\nproperty float blue\r\n"
        "element face 3\r\nproperty uchar flags\r\nproperty list uchar uint vertex_index\r\n"
        "end_header\r\n2 0.5 0.25 7\r\n"
        "0 0 0 9 0 0.5 1\r\n1 0 0 9 2 -1 nan\r\n1 1 0 9 0 0 0\r\n0 1 0 9 1 1 1\r\n"
        "1 4 0 1 2 3\r\n1 3 0 1 2\r\n1 2 0 1\r\n");
    ASSERT_TRUE(result.ok()) << result.message();
    const TriangleMesh& mesh = result.value();
    EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(1, 1, 0));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_EQ(mesh.colours[0], (Rgb8{0, 128, 255}));
    EXPECT_EQ(mesh.colours[1], (Rgb8{255, 0, 0}));
    using Triangle = std::array<std::uint32_t, 3>;
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
}

TEST(MeshIo, BinaryOfEitherByteOrder) {
    for (const bool big : {false, true}) {
        std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                           "_endian 1.0\nelement vertex 3\nproperty float x\nproperty double y\n"
                           "property short z\nproperty list uchar ushort extra\n"
                           "property ushort r\nproperty ushort g\nproperty ushort b\n"
                           "element face 1\nproperty list int short vertex_indices\nend_header\n";
        for (int i = 0; i < 3; ++i) {
            file += Bytes(0.5f + static_cast<float>(i), big);
            file += Bytes(-2.25 * i, big);
            file += Bytes(static_cast<std::int16_t>(-300 * i), big);
            file += Bytes<std::uint8_t>(2, big);
            file += Bytes<std::uint16_t>(1, big);
            file += Bytes<std::uint16_t>(2, big);
            for (const int c : {0, 32896, 65535}) file += Bytes(static_cast<std::uint16_t>(c), big);
        }
        file += Bytes<std::int32_t>(3, big);
        for (const int index : {2, 1, 0}) file += Bytes(static_cast<std::int16_t>(index), big);
        const auto result = ReadBytes(file);
        ASSERT_TRUE(result.ok()) << result.message();
        EXPECT_EQ(result.value().vertices[2], Eigen::Vector3f(2.5f, -4.5f, -600));
        EXPECT_EQ(result.value().colours[1], (Rgb8{0, 128, 255}));
        EXPECT_EQ(result.value().triangles[0], (std::array<std::uint32_t, 3>{2, 1, 0}));
    }
}

TEST(MeshIo, NormalisesNormals) {
    const auto result = ReadBytes(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n"
        "0 0 0 0 0 2\n0 0 0 0 nan 0\n");
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_EQ(result.value().normals[0], Eigen::Vector3f(0, 0, 1));
    EXPECT_EQ(result.value().normals[1], Eigen::Vector3f(0, 0, 0));
}

TEST(MeshIo, HugeCountsAreRefusedBeforeAllocation) {
    for (const char* format : {"ascii", "binary_little_endian"})
        for (const char* count : {"4000000000", "18446744073709551615", "100"}) {
            const auto result = ReadBytes(
                std::string("ply\nformat ") + format + " 1.0\nelement vertex " + count +
                "\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3 4");
            ASSERT_FALSE(result.ok());
            EXPECT_NE(result.message().find("claims"), std::string::npos) << result.message();
        }
    // An element without properties takes no bytes, whatever its count.
    const std::string head = "ply\nformat ascii 1.0\nelement vertex ";
    EXPECT_FALSE(ReadBytes(head + "18446744073709551615\nend_header\n").ok());
    EXPECT_FALSE(ReadBytes(head + "99999999999999999999\nproperty float x\nend_header\n").ok());
}

TEST(MeshIo, HostileListsEnd) {
    const std::string head = std::string(kAsciiHead) + "element face 1\nproperty list int int ";
    const std::string vertices = "end_header\n0 0 0\n0 0 1\n0 1 0\n1 0 0\n";
    for (const char* name : {"vertex_indices\n", "unknown\n"}) {
        EXPECT_FALSE(ReadBytes(head + name + vertices + "4000000000 0 1 2\n").ok());
        EXPECT_FALSE(ReadBytes(head + name + vertices + "-1 0 1 2\n").ok());
        EXPECT_FALSE(ReadBytes(head + name + vertices + "1e99 0 1 2\n").ok());
    }
    const auto outside = ReadBytes(head + "vertex_indices\n" + vertices + "3 0 1 4\n");
    ASSERT_FALSE(outside.ok());
    EXPECT_NE(outside.message().find("vertex 4 of 4"), std::string::npos) << outside.message();
    EXPECT_FALSE(ReadBytes(head + "vertex_indices\n" + vertices + "3 0 1 -1\n").ok());
    EXPECT_TRUE(ReadBytes(head + "vertex_indices\n" + vertices + "3 0 1 3").ok());
}

TEST(MeshIo, DamagedFilesAreErrorsThatNameTheFile) {
    const std::string head = kAsciiHead;
    const std::string files[] = {
        "",
        "plx\n",
        "ply\n",
        "ply\nformat ascii 1.0\n",
        "ply\nformat quaternary 1.0\nend_header\n",
        "ply\nelement vertex 0\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex -3\nend_header\n",
        "ply\nformat ascii 1.0\nproperty float x\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n1\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
        head + "end_header\n0 0 0\n0 0 1\n0 1 0\n1 0 \n",
        head + "end_header\n0 0 0\n0 0 1\n0 1 0\n1 0 x\n",
        head + "end_header\n0 0 0\n0 0 1\n0 1 0\n1 0 nan\n",
        head + "end_header\n0 0 0\n0 0 1\n0 1 0\n1 0 1e60\n",
        std::string("ply\n") + std::string(3 << 20, 'c') + "\nend_header\n",
    };
    for (const std::string& file : files) {
        const auto result = ReadBytes(file);
        ASSERT_FALSE(result.ok()) << file.substr(0, 200);
        EXPECT_NE(result.message().find(MeshPath() + ": "), std::string::npos);
        EXPECT_LT(result.message().size(), 300u);
    }
    EXPECT_FALSE(ReadPly(testing::TempDir()).ok());
    EXPECT_FALSE(ReadPly(testing::TempDir() + "absent.ply").ok());
}

TEST(MeshIo, EveryPrefixOfAFileIsAnErrorAndNoCrash) {
    ASSERT_TRUE(WritePly(MeshPath(), Tetrahedron()).ok());
    const std::string whole = ReadWholeFile(MeshPath(), 1 << 20).value();
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes)
        EXPECT_FALSE(ReadBytes(whole.substr(0, bytes)).ok()) << bytes;
    EXPECT_TRUE(ReadBytes(whole).ok());
}

}  // namespace
}  // namespace tessera
